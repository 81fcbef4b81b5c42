// SPDX-License-Identifier: BSD-3-Clause
// Boxes of voxels: margins and sizes.
#pragma once

#include <csom/core/Grid.h>

#include <cmath>

namespace csom::detail {

/// With a margin of at least `padding` metres on all sides.
inline VoxelBox padded(const VoxelBox& box, double padding, const Grid& grid) {
  const auto margin = static_cast<std::int32_t>(std::ceil(padding / grid.resolution()));
  return {{box.min.x - margin, box.min.y - margin, box.min.z - margin},
          {box.max.x + margin, box.max.y + margin, box.max.z + margin}};
}

/// Voxels along one edge of an inclusive box.
inline std::size_t edge(std::int32_t min, std::int32_t max) {
  return static_cast<std::size_t>(static_cast<std::int64_t>(max) - min + 1);
}

inline std::size_t volume(const VoxelBox& box) {
  return edge(box.min.x, box.max.x) * edge(box.min.y, box.max.y) * edge(box.min.z, box.max.z);
}

}  // namespace csom::detail
