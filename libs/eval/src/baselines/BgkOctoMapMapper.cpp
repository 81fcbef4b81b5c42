// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Kernel.h>
#include <csom/eval/BgkOctoMapMapper.h>

#include "baselines/BetaCounts.h"
#include "baselines/SparseVoxels.h"
#include "baselines/TrainingData.h"
#include "world/SegmentVoxels.h"

namespace csom {

using detail::BetaCounts;

BgkOctoMapMapper::BgkOctoMapMapper(const Options& input, const BgkOctoMapParameters& parameters)
    : input_(detail::validInput(input)),
      parameters_(parameters),
      grid_(input.resolution),
      voxels_(std::make_unique<detail::SparseVoxels<BetaCounts>>()) {
  const double r = input_.resolution;
  if (parameters_.kernel_length == 0) parameters_.kernel_length = 2 * r;
  detail::checkParameter("kernel_length", parameters_.kernel_length, r / 64, 64 * r);
  detail::checkParameter("kernel_scale", parameters_.kernel_scale, 1e-3, 1e5);
  detail::checkParameter("prior", parameters_.prior, 1e-9, 1e5);
  detail::checkParameter("occupied_threshold", parameters_.occupied_threshold, 0, 1);
}

BgkOctoMapMapper::~BgkOctoMapMapper() = default;

void BgkOctoMapMapper::insert(const Scan& scan) {
  const detail::TrainingData data = detail::makeTrainingData(scan, input_, FreeSpace::None);
  for (const Eigen::Vector3d& hit : data.hits) addSegment(hit, hit, &BetaCounts::occupied);
  for (const Eigen::Vector3d& point : data.free_points) addSegment(point, point, &BetaCounts::free);
  if (input_.free_space.mode == FreeSpace::None) return;
  for (const Eigen::Vector3d& hit : data.hits) {
    const Eigen::Vector3d beam = hit - data.origin;
    const double free_length = beam.norm() - input_.free_space.resolution;
    if (free_length > 0)
      addSegment(data.origin, data.origin + free_length * beam.normalized(), &BetaCounts::free);
  }
}

void BgkOctoMapMapper::addSegment(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                  double BetaCounts::*count) {
  const double length = parameters_.kernel_length;
  detail::forEachVoxelNearSegment(
      grid_, from, to, length, [&](const VoxelIndex& voxel, double distance) {
        const double kernel = sparseKernel(static_cast<float>(distance / length));
        (*voxels_)[voxel].*count += parameters_.kernel_scale * kernel;
      });
}

VoxelEstimate BgkOctoMapMapper::at(const Eigen::Vector3d& center) const {
  return detail::betaEstimate(*voxels_, grid_, center, parameters_.prior,
                              parameters_.occupied_threshold);
}

}  // namespace csom
