// SPDX-License-Identifier: BSD-3-Clause
// Projects the voxels of a map onto the ground.
#include "ColumnGrid.h"

#include <algorithm>
#include <limits>

namespace csom {

namespace {

/// Calls visit(VoxelIndex, class) for every voxel that passes the filter.
template <class Visitor>
void forEachSeenVoxel(const SemanticMap& map, const ColumnGrid::Filter& filter, Visitor&& visit) {
  map.forEachVoxel([&](const VoxelIndex& index, const DirichletVoxel& voxel) {
    if (filter.highest_z && map.grid().center(index).z() > *filter.highest_z) return;
    const ClassId k = voxel.mostLikelyClass();
    if (filter.hidden.count(k) == 0) visit(index, k);
  });
}

}  // namespace

ColumnGrid::ColumnGrid(const SemanticMap& map, const Filter& filter, int max_cells) {
  constexpr auto kLowest = std::numeric_limits<std::int32_t>::min();
  constexpr auto kHighest = std::numeric_limits<std::int32_t>::max();
  std::int32_t min_x = kHighest, min_y = kHighest, max_x = kLowest, max_y = kLowest;
  forEachSeenVoxel(map, filter, [&](const VoxelIndex& v, ClassId) {
    min_x = std::min(min_x, v.x);
    max_x = std::max(max_x, v.x);
    min_y = std::min(min_y, v.y);
    max_y = std::max(max_y, v.y);
  });
  if (min_x > max_x) return;

  const int longest_side = std::max(max_x - min_x, max_y - min_y) + 1;
  voxels_per_cell_ = (longest_side + max_cells - 1) / max_cells;
  width_ = (max_x - min_x) / voxels_per_cell_ + 1;
  height_ = (max_y - min_y) / voxels_per_cell_ + 1;
  columns_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));

  forEachSeenVoxel(map, filter, [&](const VoxelIndex& v, ClassId k) {
    const int column = (v.x - min_x) / voxels_per_cell_;
    const int row = height_ - 1 - (v.y - min_y) / voxels_per_cell_;
    Column& cell = columns_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                            static_cast<std::size_t>(column)];
    const bool occupied = k != kFreeClass;
    if (!occupied) {
      if (cell.state == VoxelState::Unknown) cell.state = VoxelState::Free;
    } else if (cell.state != VoxelState::Occupied || v.z > cell.top) {
      cell = {VoxelState::Occupied, k, v.z};
    }
  });
}

}  // namespace csom
