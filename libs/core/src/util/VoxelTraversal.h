// SPDX-License-Identifier: BSD-3-Clause
// Exact walk along a segment from voxel to voxel (Amanatides and Woo, 1987).
#pragma once

#include <csom/core/Grid.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace csom::detail {

/// Visits the voxels that the segment from `origin` to `target` crosses, in order, from that of its
/// start to that of its end. visit(voxel, t) returns false to stop; t in [0, 1] is where the
/// segment enters the voxel. Both ends must lie inside the grid. Crossings are computed from the
/// integer planes, not by repeated addition, and the number of steps is known beforehand: the walk
/// ends in the right voxel, always.
template <class Visitor>
void traverseVoxels(const Grid& grid, const Eigen::Vector3d& origin, const Eigen::Vector3d& target,
                    Visitor&& visit) {
  const Eigen::Vector3d displacement = target - origin;
  const VoxelIndex first = grid.voxelAt(origin);
  const VoxelIndex last = grid.voxelAt(target);
  std::array<std::int32_t, 3> at{first.x, first.y, first.z};
  const std::array<std::int32_t, 3> end{last.x, last.y, last.z};
  std::array<std::int32_t, 3> step{};
  std::array<std::int64_t, 3> left{};
  std::array<double, 3> next{};
  std::int64_t steps = 0;
  const auto crossing = [&](std::size_t a) {
    if (left[a] == 0) return std::numeric_limits<double>::infinity();
    const auto axis = static_cast<Eigen::Index>(a);
    const double plane = grid.resolution() * (step[a] > 0 ? at[a] + 1 : at[a]);
    return (plane - origin[axis]) / displacement[axis];
  };
  for (std::size_t a = 0; a < 3; ++a) {
    step[a] = end[a] > at[a] ? 1 : -1;
    left[a] = std::abs(static_cast<std::int64_t>(end[a]) - at[a]);
    steps += left[a];
    next[a] = crossing(a);
  }
  double entered = 0;
  for (; visit(VoxelIndex{at[0], at[1], at[2]}, entered) && steps > 0; --steps) {
    const std::size_t axis =
        next[0] <= next[1] ? (next[0] <= next[2] ? 0 : 2) : (next[1] <= next[2] ? 1 : 2);
    entered = next[axis];
    at[axis] += step[axis];
    --left[axis];
    next[axis] = crossing(axis);
  }
}

}  // namespace csom::detail
