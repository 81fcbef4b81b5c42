// SPDX-License-Identifier: BSD-3-Clause
// The innermost loops: which points may reach a block, and the kernel mass that they give to eight
// of its voxels. All positions and lengths are in voxels, from the lower corner of the block's
// chunk.
#pragma once

#include <csom/core/Options.h>
#include <csom/core/ScanPreparation.h>

#include <array>
#include <cstdint>
#include <vector>

#include "BlockWindow.h"
#include "LaneSums.h"
#include "Lanes.h"

namespace csom::detail {

/// Eight voxels of a block (one, if the block is a voxel).
struct alignas(kLaneAlignment) LaneGroup {
  Lanes x{}, y{}, z{};                     ///< centres, from the block's lower corner
  std::array<VoxelIndex, kLanes> voxel{};  ///< relative to the block's first voxel
};

struct BlockPlace {
  float x, y, z;  ///< lower corner of the block
  float edge;     ///< of the block
};

/// Points first … last−1 of a window.
struct PointRange {
  std::uint32_t first;
  std::uint32_t last;
};

/// Lists, in order, the points of the ranges that are nearer than `length` to the box of the
/// block's voxel centres.
void selectNearby(const BlockWindow& window, const std::vector<PointRange>& ranges,
                  const BlockPlace& block, float length, std::vector<std::uint32_t>& selected);

/// Adds the kernel mass of the selected points of a window to the voxels of a group of a block, in
/// their order, with the labels or (if there are any) the scores of `scan`.
void addKernelMass(Kernel kernel, const BlockWindow& window,
                   const std::vector<std::uint32_t>& selected, const PreparedScan& scan,
                   const LaneGroup& group, const BlockPlace& block, float length, LaneSums& sums);

}  // namespace csom::detail
