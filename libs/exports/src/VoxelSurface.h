// SPDX-License-Identifier: BSD-3-Clause
// The surface of occupied voxels as rectangles.
#pragma once

#include <csom/exports/VoxelSelection.h>

#include <array>
#include <cstdint>
#include <vector>

namespace csom::detail {

/// Coplanar faces of voxels of one class, merged. Positions are corners of the grid of the export's
/// frame: corner i lies at i·r.
struct SurfaceRectangle {
  ClassId class_id;
  int axis;       ///< of the normal: 0 = x, 1 = y, 2 = z
  bool positive;  ///< the normal points along +axis
  std::int32_t plane;
  /// Along the two axes after `axis`, in the order x → y → z → x.
  std::array<std::int32_t, 2> min;
  std::array<std::int32_t, 2> max;

  /// Counter-clockwise, seen from outside.
  std::array<VoxelIndex, 4> corners() const;
};

/// The faces between an occupied voxel of the selection and what is none, merged greedily: first
/// along a row, then rows of equal extent. Needs a byte a voxel of every chunk in use, and 16 bytes
/// a face of one of the six directions at a time. Throws as VoxelSelection::forEachResampled.
std::vector<SurfaceRectangle> voxelSurface(const VoxelSelection& voxels);

}  // namespace csom::detail
