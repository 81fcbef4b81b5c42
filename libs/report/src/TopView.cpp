// SPDX-License-Identifier: BSD-3-Clause
// Draws a map from above: the raster of columns, a scale bar, the axes and a legend.
#include <csom/report/Format.h>
#include <csom/report/TopView.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "Canvas.h"
#include "ColumnGrid.h"
#include "Legend.h"
#include "Palette.h"

namespace csom {

namespace {

constexpr int kMargin = 20;
constexpr int kFooterHeight = 68;
constexpr int kLargestVoxel = 24;
// Room for the scale bar and the caption, however small the map.
constexpr int kSmallestPanel = 300;

ColumnGrid::Filter filterOf(const LabelSet& labels, const TopViewOptions& options) {
  ColumnGrid::Filter filter;
  filter.highest = options.highest;
  for (const std::string& name : options.hidden_classes)
    if (const auto k = labels.classByName(name)) filter.hidden.insert(*k);
  return filter;
}

/// Heights of the occupied columns without the outermost two percent.
struct HeightRange {
  double low = 0;
  double high = 1;
};

HeightRange heightRange(const ColumnGrid& grid) {
  std::vector<std::int32_t> tops;
  for (const Column& column : grid.columns())
    if (column.state == VoxelState::Occupied) tops.push_back(column.top);
  if (tops.empty()) return {};
  const auto at = [&](std::size_t rank) {
    std::nth_element(tops.begin(), tops.begin() + static_cast<std::ptrdiff_t>(rank), tops.end());
    return tops[rank];
  };
  const std::size_t last = tops.size() - 1;
  const double low = at(last / 50);
  return {low, std::max(low + 1, double(at(last - last / 50)))};
}

/// 1 = the class's own colour. Higher is lighter; faces towards the upper left catch light.
double brightness(const ColumnGrid& grid, const HeightRange& range, int column, int row) {
  const double top = grid.at(column, row).top;
  const double height = std::clamp((top - range.low) / (range.high - range.low), 0.0, 1.0);
  const auto rise = [&](int c, int r) {
    if (c < 0 || r < 0 || grid.at(c, r).state != VoxelState::Occupied) return 0.0;
    return top - grid.at(c, r).top;
  };
  const double slope = (rise(column - 1, row) + rise(column, row - 1)) / 2;
  return 0.90 + 0.20 * height + 0.16 * std::tanh(slope / 4);
}

/// Darker below 1, towards white above.
cv::Vec3b shade(const Color& color, double brightness) {
  const auto channel = [&](std::size_t i) {
    const double c = color[i];
    const double shaded = brightness < 1 ? c * brightness : c + (255 - c) * (brightness - 1);
    return static_cast<std::uint8_t>(std::lround(std::clamp(shaded, 0.0, 255.0)));
  };
  return {channel(2), channel(1), channel(0)};
}

cv::Mat paintCells(const ColumnGrid& grid, const LabelSet& labels) {
  const HeightRange range = heightRange(grid);
  cv::Mat cells(grid.height(), grid.width(), CV_8UC3);
  for (int row = 0; row < grid.height(); ++row) {
    for (int column = 0; column < grid.width(); ++column) {
      const Column& cell = grid.at(column, row);
      auto& pixel = cells.at<cv::Vec3b>(row, column);
      if (cell.state == VoxelState::Occupied)
        pixel = shade(classOf(labels, cell.top_class).color, brightness(grid, range, column, row));
      else
        pixel = shade(cell.state == VoxelState::Free ? kFreeSpace : kUnknown, 1.0);
    }
  }
  return cells;
}

/// 1, 2 or 5 times a power of ten, at most `longest`.
double roundLength(double longest) {
  const double power = std::pow(10.0, std::floor(std::log10(longest)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= longest) return factor * power;
  return power;
}

void drawScaleBar(Canvas& canvas, cv::Point left, double metres_per_pixel) {
  const double length = roundLength(kSmallestPanel / 2.0 * metres_per_pixel);
  const cv::Point right = left + cv::Point(int(std::lround(length / metres_per_pixel)), 0);
  const cv::Point tick(0, 5);
  canvas.line(left, right, kInk);
  canvas.line(left - tick, left + tick, kInk);
  canvas.line(right - tick, right + tick, kInk);
  canvas.text(formatLength(length), left + cv::Point(0, 24), kInk);
}

void drawAxes(Canvas& canvas, const ViewAxes& axes, cv::Point origin) {
  constexpr int kLength = 28;
  canvas.arrow(origin, origin + cv::Point(kLength, 0), kInk);
  canvas.arrow(origin, origin - cv::Point(0, kLength), kInk);
  canvas.text(axes.right.name(), origin + cv::Point(kLength + 4, 4), kInk);
  canvas.text(axes.top.name(), origin + cv::Point(-4, -kLength - 6), kInk);
}

std::vector<std::uint8_t> emptyPicture(bool map_is_empty) {
  const std::string message =
      map_is_empty ? "The map is empty." : "Nothing of the map is below the cut.";
  Canvas canvas(Canvas::textWidth(message) + 4 * kMargin, 6 * kMargin);
  canvas.text(message, {2 * kMargin, 3 * kMargin + 5}, kInk);
  return canvas.toPng();
}

}  // namespace

std::vector<std::uint8_t> topViewPng(const MapDocument& document, const TopViewOptions& options) {
  if (options.max_pixels < 64 || options.max_pixels > 4096)
    throw std::invalid_argument("max_pixels of a top view must be 64 … 4096, not " +
                                std::to_string(options.max_pixels));
  const ViewAxes axes = ViewAxes::lookingDown(options.up);
  const ColumnGrid grid(document.map, axes, filterOf(document.labels, options), options.max_pixels);
  if (grid.empty()) return emptyPicture(document.map.empty());

  const int cell_size =
      std::clamp(options.max_pixels / std::max(grid.width(), grid.height()), 1, kLargestVoxel);
  const cv::Size drawn(grid.width() * cell_size, grid.height() * cell_size);
  const Legend legend(grid, document.labels);
  const cv::Rect panel(kMargin, kMargin, std::max(drawn.width, kSmallestPanel),
                       std::max({drawn.height, legend.height(), kSmallestPanel / 2}));

  Canvas canvas(panel.br().x + kMargin + legend.width() + kMargin,
                panel.br().y + kFooterHeight + kMargin);
  const cv::Point centering((panel.width - drawn.width) / 2, (panel.height - drawn.height) / 2);
  canvas.image(paintCells(grid, document.labels), panel.tl() + centering, cell_size);
  canvas.frame(panel, kFrame);
  legend.draw(canvas, {panel.br().x + kMargin, panel.y});
  const double metres_per_pixel =
      document.map.grid().resolution() * grid.voxelsPerCell() / cell_size;
  drawScaleBar(canvas, {panel.x, panel.br().y + 30}, metres_per_pixel);
  drawAxes(canvas, axes, {panel.br().x - 50, panel.br().y + 60});
  return canvas.toPng();
}

}  // namespace csom
