// SPDX-License-Identifier: BSD-3-Clause
// The Beta posterior of a voxel's occupancy, as Bayesian kernel inference keeps it.
#pragma once

#include <csom/eval/Mapper.h>

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

}  // namespace csom::detail
