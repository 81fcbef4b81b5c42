// SPDX-License-Identifier: BSD-3-Clause
// Paints the raster of columns.
#include "AxisView.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "Canvas.h"
#include "Palette.h"
#include "Shading.h"

namespace csom {

namespace {

constexpr int kLargestVoxel = 24;

CommonRange depthRange(const ColumnGrid& grid) {
  std::vector<std::int32_t> tops;
  for (const Column& column : grid.columns())
    if (column.state == VoxelState::Occupied) tops.push_back(column.top);
  return CommonRange(std::move(tops));
}

/// 1 = the class's own colour. Nearer is lighter; faces towards the upper left catch light.
double brightness(const ColumnGrid& grid, const CommonRange& range, int column, int row) {
  const double top = grid.at(column, row).top;
  const auto rise = [&](int c, int r) {
    if (c < 0 || r < 0 || grid.at(c, r).state != VoxelState::Occupied) return 0.0;
    return top - grid.at(c, r).top;
  };
  const double slope = (rise(column - 1, row) + rise(column, row - 1)) / 2;
  return 0.90 + 0.20 * range.share(top) + 0.16 * std::tanh(slope / 4);
}

cv::Mat paintCells(const ColumnGrid& grid, const std::vector<Color>& colors) {
  const CommonRange range = depthRange(grid);
  cv::Mat cells(grid.height(), grid.width(), CV_8UC3);
  for (int row = 0; row < grid.height(); ++row) {
    for (int column = 0; column < grid.width(); ++column) {
      const Column& cell = grid.at(column, row);
      auto& pixel = cells.at<cv::Vec3b>(row, column);
      if (cell.state == VoxelState::Occupied)
        pixel = shade(colors[cell.top_class], brightness(grid, range, column, row));
      else
        pixel = shade(cell.state == VoxelState::Free ? kFreeSpace : kUnknown, 1.0);
    }
  }
  return cells;
}

}  // namespace

std::optional<DrawnMap> drawAlongAxis(const SemanticMap& map, const Sight& sight,
                                      const VoxelFilter& filter, const std::vector<Color>& colors,
                                      int max_pixels) {
  const ColumnGrid grid(map, sight, filter, max_pixels);
  if (grid.empty()) return std::nullopt;
  DrawnMap drawn;
  const int cell_size =
      std::clamp(max_pixels / std::max(grid.width(), grid.height()), 1, kLargestVoxel);
  const cv::Mat cells = paintCells(grid, colors);
  cv::resize(cells, drawn.picture, cells.size() * (cell_size * Canvas::kScale), 0, 0,
             cv::INTER_NEAREST);
  drawn.metres_per_pixel = map.grid().resolution() * grid.voxelsPerCell() / cell_size;
  drawn.axes = {{sight.right.name(), {1, 0}}, {sight.top.name(), {0, -1}}};
  for (const Column& column : grid.columns()) {
    if (column.state == VoxelState::Occupied) ++drawn.seen[column.top_class];
    drawn.free_space = drawn.free_space || column.state == VoxelState::Free;
  }
  drawn.left_out = grid.leftOut();
  return drawn;
}

}  // namespace csom
