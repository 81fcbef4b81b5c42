// SPDX-License-Identifier: BSD-3-Clause
// Projects the voxels of a map onto a plane.
#include "ColumnGrid.h"

#include <algorithm>
#include <limits>

namespace csom {

namespace {

/// A voxel as one looks at it.
struct SeenVoxel {
  std::int32_t right, top, eye;
};

/// Calls visit(SeenVoxel, class) for every voxel below the cut, hidden classes included.
template <class Visitor>
void forEachLowVoxel(const SemanticMap& map, const Sight& sight, const VoxelFilter& filter,
                     Visitor&& visit) {
  map.forEachVoxel([&](const VoxelIndex& index, const DirichletVoxel& voxel) {
    if (filter.highest && filter.up.along(map.grid().center(index)) > *filter.highest) return;
    visit(SeenVoxel{sight.right.along(index), sight.top.along(index), sight.eye.along(index)},
          voxel.mostLikelyClass());
  });
}

}  // namespace

ColumnGrid::ColumnGrid(const SemanticMap& map, const Sight& sight, const VoxelFilter& filter,
                       int max_cells) {
  constexpr auto kLowest = std::numeric_limits<std::int32_t>::min();
  constexpr auto kHighest = std::numeric_limits<std::int32_t>::max();
  std::int32_t min_right = kHighest, min_top = kHighest, max_right = kLowest, max_top = kLowest;
  forEachLowVoxel(map, sight, filter, [&](const SeenVoxel& v, ClassId k) {
    if (filter.hidden.count(k) > 0) {
      left_out_.insert(k);
      return;
    }
    min_right = std::min(min_right, v.right);
    max_right = std::max(max_right, v.right);
    min_top = std::min(min_top, v.top);
    max_top = std::max(max_top, v.top);
  });
  if (min_right > max_right) return;

  const int longest_side = std::max(max_right - min_right, max_top - min_top) + 1;
  voxels_per_cell_ = (longest_side + max_cells - 1) / max_cells;
  width_ = (max_right - min_right) / voxels_per_cell_ + 1;
  height_ = (max_top - min_top) / voxels_per_cell_ + 1;
  columns_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));

  forEachLowVoxel(map, sight, filter, [&](const SeenVoxel& v, ClassId k) {
    if (filter.hidden.count(k) > 0) return;
    const int column = (v.right - min_right) / voxels_per_cell_;
    const int row = height_ - 1 - (v.top - min_top) / voxels_per_cell_;
    Column& cell = columns_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                            static_cast<std::size_t>(column)];
    const bool occupied = k != kFreeClass;
    if (!occupied) {
      if (cell.state == VoxelState::Unknown) cell.state = VoxelState::Free;
    } else if (cell.state != VoxelState::Occupied || v.eye > cell.top) {
      cell = {VoxelState::Occupied, k, v.eye};
    }
  });
}

}  // namespace csom
