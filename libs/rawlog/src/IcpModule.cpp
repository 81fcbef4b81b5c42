// SPDX-License-Identifier: BSD-3-Clause
// csom-icp.so: MRPT's ICP.
#include "IcpModule.h"

#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/slam/CICP.h>

extern "C" void csomAlignPoints(const mrpt::maps::CSimplePointsMap& reference,
                                const mrpt::maps::CSimplePointsMap& points,
                                csom::detail::Alignment& alignment) {
  mrpt::slam::CICP::TConfigParams options;
  options.maxIterations = 100;
  options.minAbsStep_trans = 1e-3;
  options.minAbsStep_rot = 1e-4;
  options.thresholdDist = alignment.first_distance;
  options.thresholdAng = 0;
  options.ALFA = 0.7;
  options.smallestThresholdDist = alignment.last_distance;
  options.corresponding_points_decimation = 1;
  options.skip_cov_calculation = true;
  mrpt::slam::CICP icp(options);
  mrpt::slam::CICP::TReturnInfo info;
  const auto found =
      icp.Align3DPDF(&reference, &points, mrpt::poses::CPose3DPDFGaussian(alignment.pose), info);
  alignment.pose = found->getMeanVal();
  alignment.overlap = info.goodness;
}
