// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Kernel.h>
#include <csom/eval/AkiMapMapper.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "baselines/AdaptiveKernel.h"
#include "baselines/BetaCounts.h"
#include "baselines/SparseVoxels.h"
#include "baselines/TrainingData.h"

namespace csom {

using detail::AdaptiveKernel;
using detail::BetaCounts;
using detail::OccupancySample;

AkiMapMapper::AkiMapMapper(const Options& input, const AkiMapParameters& parameters)
    : input_(detail::validInput(input)),
      parameters_(parameters),
      grid_(input.resolution),
      voxels_(std::make_unique<detail::SparseVoxels<BetaCounts>>()) {
  const double r = input_.resolution;
  if (parameters_.max_search_radius == 0)
    parameters_.max_search_radius = std::clamp(input_.free_space.resolution, r, 64 * r);
  if (parameters_.variance_noise == 0) parameters_.variance_noise = std::max(0.001, 0.1 * r * r);
  detail::checkParameter("max_search_radius", parameters_.max_search_radius, r, 64 * r);
  detail::checkParameter("sensing_range", parameters_.sensing_range, 1e-3, 1e7);
  detail::checkParameter("variance_noise", parameters_.variance_noise, 1e-6 * r * r, 1e3 * r * r);
  detail::checkParameter("prior", parameters_.prior, 1e-9, 1e5);
  detail::checkParameter("occupied_threshold", parameters_.occupied_threshold, 0, 1);
}

AkiMapMapper::~AkiMapMapper() = default;

void AkiMapMapper::insert(const Scan& scan) {
  const detail::TrainingData data = detail::makeTrainingData(scan, input_, input_.free_space.mode);
  std::vector<OccupancySample> samples;
  std::set<VoxelIndex> taken;
  const auto addSample = [&](const Eigen::Vector3d& position, bool occupied) {
    if (taken.insert(grid_.voxelAt(position)).second) samples.push_back({position, occupied});
  };
  for (const Eigen::Vector3d& hit : data.hits) addSample(hit, true);
  if (!data.hits.empty() && input_.free_space.mode != FreeSpace::None)
    addSample(data.origin, false);
  for (const Eigen::Vector3d& point : data.free_points) addSample(point, false);

  const detail::AdaptiveKernelFit fit(samples, data.origin,
                                      {input_.resolution, parameters_.max_search_radius,
                                       parameters_.sensing_range, parameters_.variance_noise});
  for (std::size_t i = 0; i < samples.size(); ++i)
    add(fit.kernelOf(i), samples[i].occupied ? &BetaCounts::occupied : &BetaCounts::free);
}

void AkiMapMapper::add(const AdaptiveKernel& kernel, double BetaCounts::*count) {
  const Eigen::Vector3d half = kernel.halfExtent();
  const VoxelIndex min = grid_.voxelAt(kernel.center - half);
  const VoxelIndex max = grid_.voxelAt(kernel.center + half);
  const double weight = kernel.weight();
  for (std::int32_t z = min.z; z <= max.z; ++z)
    for (std::int32_t y = min.y; y <= max.y; ++y)
      for (std::int32_t x = min.x; x <= max.x; ++x) {
        const VoxelIndex voxel{x, y, z};
        const double distance = kernel.distance(grid_.center(voxel));
        if (distance < 1)
          (*voxels_)[voxel].*count += weight * sparseKernel(static_cast<float>(distance));
      }
}

VoxelEstimate AkiMapMapper::at(const Eigen::Vector3d& center) const {
  return detail::betaEstimate(*voxels_, grid_, center, parameters_.prior,
                              parameters_.occupied_threshold);
}

}  // namespace csom
