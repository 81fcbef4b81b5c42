// SPDX-License-Identifier: BSD-3-Clause
// The Beta posterior of a voxel's occupancy, as Bayesian kernel inference keeps it.
#pragma once

#include <csom/core/Grid.h>
#include <csom/eval/Mapper.h>

#include "baselines/SparseVoxels.h"

namespace csom::detail {

struct BetaCounts {
  double occupied = 0;  ///< α without its prior
  double free = 0;      ///< β without its prior

  bool known() const { return occupied + free > 0; }
  /// Posterior mean, with the same prior for α and β.
  double occupancy(double prior) const {
    return (prior + occupied) / (2 * prior + occupied + free);
  }
};

/// What a method without classes says of a known voxel.
inline VoxelEstimate occupancyEstimate(double occupancy, double occupied_threshold) {
  return {true,
          occupancy,
          static_cast<ClassId>(occupancy > occupied_threshold ? 1 : kFreeClass),
          {1 - occupancy, occupancy}};
}

/// What Beta counts say of the voxel at a point.
inline VoxelEstimate betaEstimate(const SparseVoxels<BetaCounts>& voxels, const Grid& grid,
                                  const Eigen::Vector3d& point, double prior,
                                  double occupied_threshold) {
  if (!grid.contains(point)) return {};
  const BetaCounts* counts = voxels.find(grid.voxelAt(point));
  if (counts == nullptr || !counts->known()) return {};
  return occupancyEstimate(counts->occupancy(prior), occupied_threshold);
}

}  // namespace csom::detail
