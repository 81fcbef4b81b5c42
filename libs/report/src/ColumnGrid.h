// SPDX-License-Identifier: BSD-3-Clause
// A map seen along one of its axes, before it is drawn: one column of voxels a cell.
#pragma once

#include <csom/core/SemanticMap.h>

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "ViewAxes.h"

namespace csom {

/// How one looks: `right` and `top` of the picture, `eye` towards the one who looks; right-handed.
struct Sight {
  SignedAxis right;
  SignedAxis top;
  SignedAxis eye;
};

/// What one sees looking along a column.
struct Column {
  VoxelState state = VoxelState::Unknown;
  ClassId top_class = kFreeClass;  ///< if occupied
  std::int32_t top = 0;            ///< index of the nearest occupied voxel towards the eye
};

/// Which voxels of a map are drawn.
struct VoxelFilter {
  SignedAxis up;
  std::optional<double> highest;  ///< voxels with a centre that is higher along `up` are not [m]
  std::set<ClassId> hidden;       ///< nor are those of these classes
};

/// A raster of columns, row 0 at the top of the picture.
class ColumnGrid {
 public:
  /// Covers all seen voxels with at most `max_cells` cells a side; each cell then holds several
  /// voxels a side.
  ColumnGrid(const SemanticMap& map, const Sight& sight, const VoxelFilter& filter, int max_cells);

  bool empty() const { return columns_.empty(); }
  int width() const { return width_; }
  int height() const { return height_; }
  /// Voxels along the edge of a cell.
  int voxelsPerCell() const { return voxels_per_cell_; }
  const Column& at(int column, int row) const {
    return columns_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(column)];
  }
  const std::vector<Column>& columns() const { return columns_; }
  /// Hidden classes that the map does have.
  const std::set<ClassId>& leftOut() const { return left_out_; }

 private:
  int width_ = 0;
  int height_ = 0;
  int voxels_per_cell_ = 1;
  std::vector<Column> columns_;
  std::set<ClassId> left_out_;
};

}  // namespace csom
