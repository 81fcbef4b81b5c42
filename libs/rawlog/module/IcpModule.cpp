// SPDX-License-Identifier: BSD-3-Clause
// csom-icp.so: MRPT's ICP.
#include "poses/IcpModule.h"

#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/slam/CICP.h>

extern "C" void csomAlignPoints(const mrpt::maps::CSimplePointsMap& reference,
                                const mrpt::maps::CSimplePointsMap& points,
                                const mrpt::poses::CPose3D& expected,
                                csom::detail::Alignment& found) {
  // Chosen by measurement, with those of ScanRegistration.cpp (docs/poses.md).
  mrpt::slam::CICP::TConfigParams options;
  options.maxIterations = 100;
  options.minAbsStep_trans = 1e-3;
  options.minAbsStep_rot = 1e-4;
  options.thresholdDist = csom::detail::kLargestCorrection;
  options.thresholdAng = 0;
  options.ALFA = 0.7;
  options.smallestThresholdDist = 0.1;  // [m] what ICP narrows its pairs to
  options.corresponding_points_decimation = 1;
  options.skip_cov_calculation = true;
  mrpt::slam::CICP icp(options);
  mrpt::slam::CICP::TReturnInfo info;
  const auto pose =
      icp.Align3DPDF(&reference, &points, mrpt::poses::CPose3DPDFGaussian(expected), info);
  found = {pose->getMeanVal(), info.goodness};
}
