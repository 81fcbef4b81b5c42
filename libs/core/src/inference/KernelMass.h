// SPDX-License-Identifier: BSD-3-Clause
// The innermost loops: which points may reach a block, and the kernel mass that they give to eight
// of its voxels.
#pragma once

#include <csom/core/Options.h>

#include <array>
#include <cstdint>
#include <vector>

#include "inference/LaneSums.h"
#include "inference/PointColumns.h"
#include "util/Lanes.h"

namespace csom::detail {

/// Eight voxels of a block (one, if the block is a voxel).
struct alignas(kLaneAlignment) LaneGroup {
  WordLanes x{}, y{}, z{};                 ///< centres, from the block's lower corner (FixedPoint)
  std::array<VoxelIndex, kLanes> voxel{};  ///< relative to the block's first voxel
};

/// The groups that make up a block.
std::vector<LaneGroup> laneGroups(const BlockLayout& layout);

/// Points first … last−1 of a scan.
struct PointRange {
  std::uint32_t first;
  std::uint32_t last;
};

/// Lists, in order, the points of the ranges that are nearer than `length` voxels to the box of the
/// block's voxel centres.
void selectNearby(const PointColumns& points, const std::vector<PointRange>& ranges,
                  const BlockPlace& block, float length, std::vector<std::uint32_t>& selected);

/// Sums the kernel mass of the selected points for the voxels of a group of a block, in their
/// order, with their labels or (if there are any) their scores. `length` in voxels. `counts`
/// receives for each of sums.classes() the mass, times `scale`, as counts.
void sumKernelMass(Kernel kernel, const PointColumns& points,
                   const std::vector<std::uint32_t>& selected, const std::vector<float>& scores,
                   const LaneGroup& group, const BlockPlace& block, float length, double scale,
                   LaneSums& sums, std::vector<CountLanes>& counts);

}  // namespace csom::detail
