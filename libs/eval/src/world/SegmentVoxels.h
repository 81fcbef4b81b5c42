// SPDX-License-Identifier: BSD-3-Clause
// The voxels whose centres lie near a line segment.
#pragma once

#include <csom/core/Grid.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace csom::detail {

/// Calls `visit(VoxelIndex, distance)` for each voxel whose centre is nearer than `radius` to the
/// segment from `a` to `b`, which may be a point.
template <class Visitor>
void forEachVoxelNearSegment(const Grid& grid, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                             double radius, Visitor&& visit) {
  const double length = (b - a).norm();
  const Eigen::Vector3d direction =
      length > 0 ? Eigen::Vector3d((b - a) / length) : Eigen::Vector3d(Eigen::Vector3d::UnitX());
  // Slice by slice across the axis that the segment follows most: in each, the rectangle around
  // the ellipse in which the slice cuts the cylinder of that radius.
  int axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const double half_u =
      radius * std::sqrt(1 - direction[v] * direction[v]) / std::abs(direction[axis]);
  const double half_v =
      radius * std::sqrt(1 - direction[u] * direction[u]) / std::abs(direction[axis]);
  // Of the centres on that side of a coordinate, the one next to it. Which way a centre at the very
  // radius is rounded does not matter: kernels are 0 there.
  const auto firstFrom = [&](double coordinate) {
    return static_cast<std::int32_t>(std::ceil(coordinate / grid.resolution() - 0.5));
  };
  const auto lastTo = [&](double coordinate) {
    return static_cast<std::int32_t>(std::floor(coordinate / grid.resolution() - 0.5));
  };
  const auto center = [&](std::int32_t index) { return (index + 0.5) * grid.resolution(); };

  std::array<std::int32_t, 3> index{};
  Eigen::Vector3d point;
  const std::int32_t last = lastTo(std::max(a[axis], b[axis]) + radius);
  for (std::int32_t i = firstFrom(std::min(a[axis], b[axis]) - radius); i <= last; ++i) {
    index[static_cast<std::size_t>(axis)] = i;
    point[axis] = center(i);
    const Eigen::Vector3d middle = a + (point[axis] - a[axis]) / direction[axis] * direction;
    const std::int32_t last_u = lastTo(middle[u] + half_u);
    const std::int32_t last_v = lastTo(middle[v] + half_v);
    for (std::int32_t j = firstFrom(middle[u] - half_u); j <= last_u; ++j) {
      index[static_cast<std::size_t>(u)] = j;
      point[u] = center(j);
      for (std::int32_t k = firstFrom(middle[v] - half_v); k <= last_v; ++k) {
        index[static_cast<std::size_t>(v)] = k;
        point[v] = center(k);
        const double along = std::clamp((point - a).dot(direction), 0.0, length);
        const double squared = (point - (a + along * direction)).squaredNorm();
        if (squared < radius * radius)
          visit(VoxelIndex{index[0], index[1], index[2]}, std::sqrt(squared));
      }
    }
  }
}

}  // namespace csom::detail
