// SPDX-License-Identifier: BSD-3-Clause
// Puts a drawn map, its scale bar, its axes and its legend together.
#include <csom/report/Format.h>
#include <csom/report/MapPicture.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "AxisView.h"
#include "Canvas.h"
#include "ClassColors.h"
#include "IsometricView.h"
#include "Legend.h"
#include "Palette.h"
#include "ViewAxes.h"

namespace csom {

namespace {

constexpr int kMargin = 20;
constexpr int kFooterHeight = 68;
// Room for the scale bar and the axes, however small the map.
constexpr int kSmallestPanel = 300;

VoxelFilter filterOf(const LabelSet& labels, const ViewAxes& axes,
                     const MapPictureOptions& options) {
  VoxelFilter filter;
  filter.up = axes.up;
  filter.highest = options.highest;
  for (const std::string& name : options.hidden_classes)
    if (const auto k = labels.classByName(name)) filter.hidden.insert(*k);
  return filter;
}

std::optional<DrawnMap> draw(const MapDocument& document, MapView view,
                             const MapPictureOptions& options, const std::vector<Color>& colors) {
  const ViewAxes axes = ViewAxes::standing(options.up);
  const VoxelFilter filter = filterOf(document.labels, axes, options);
  const auto alongAxis = [&](const Sight& sight) {
    return drawAlongAxis(document.map, sight, filter, colors, options.max_pixels);
  };
  switch (view) {
    case MapView::Top:
      return alongAxis({axes.right, axes.ahead, axes.up});
    case MapView::Front:
      return alongAxis({axes.right, axes.up, axes.ahead.reversed()});
    case MapView::Side:
      return alongAxis({axes.ahead, axes.up, axes.right});
    case MapView::Isometric:
      return drawIsometric(document.map, axes, filter, colors, options.max_pixels);
  }
  return std::nullopt;
}

/// 1, 2 or 5 times a power of ten, at most `longest`.
double roundLength(double longest) {
  const double power = std::pow(10.0, std::floor(std::log10(longest)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= longest) return factor * power;
  return power;
}

void drawScaleBar(Canvas& canvas, cv::Point left, double metres_per_pixel,
                  const std::string& note) {
  const double length = roundLength(kSmallestPanel / 2.0 * metres_per_pixel);
  const cv::Point right = left + cv::Point(int(std::lround(length / metres_per_pixel)), 0);
  const cv::Point tick(0, 5);
  canvas.line(left, right, kInk);
  canvas.line(left - tick, left + tick, kInk);
  canvas.line(right - tick, right + tick, kInk);
  canvas.text(formatLength(length) + note, left + cv::Point(0, 24), kInk);
}

/// Arrows along the axes of the map; the first one, along x wherever that is possible, is its
/// north.
void drawAxes(Canvas& canvas, const std::vector<DrawnAxis>& axes, cv::Point origin) {
  constexpr double kLength = 30;
  for (const DrawnAxis& axis : axes) {
    const cv::Point tip(int(std::lround(kLength * axis.direction.x)),
                        int(std::lround(kLength * axis.direction.y)));
    canvas.arrow(origin, origin + tip, kInk);
    const int width = Canvas::textWidth(axis.name);
    const cv::Point beside(axis.direction.x > 0.1    ? 4
                           : axis.direction.x < -0.1 ? -4 - width
                                                     : -width / 2,
                           axis.direction.x == 0 ? -6 : 4);
    canvas.text(axis.name, origin + tip + beside, kInk);
  }
}

std::vector<std::uint8_t> emptyPicture(bool map_is_empty) {
  const std::string message =
      map_is_empty ? "The map is empty." : "There is nothing to see of the map from here.";
  Canvas canvas(Canvas::textWidth(message) + 4 * kMargin, 6 * kMargin);
  canvas.text(message, {2 * kMargin, 3 * kMargin + 5}, kInk);
  return canvas.toPng();
}

}  // namespace

const char* toString(MapView view) {
  switch (view) {
    case MapView::Top:
      return "top";
    case MapView::Front:
      return "front";
    case MapView::Side:
      return "side";
    case MapView::Isometric:
      return "isometric";
  }
  return "";
}

std::vector<std::uint8_t> mapPicturePng(const MapDocument& document, MapView view,
                                        const MapPictureOptions& options) {
  if (options.max_pixels < 64 || options.max_pixels > 4096)
    throw std::invalid_argument("max_pixels of a picture must be 64 … 4096, not " +
                                std::to_string(options.max_pixels));
  const std::vector<Color> colors =
      options.color_blind_safe ? colorBlindSafeColors(document) : labelColors(document);
  const std::optional<DrawnMap> drawn = draw(document, view, options, colors);
  if (!drawn) return emptyPicture(document.map.empty());

  const cv::Size size = drawn->picture.size() / Canvas::kScale;
  const Legend legend(*drawn, document.labels, colors);
  const cv::Rect panel(kMargin, kMargin, std::max(size.width, kSmallestPanel),
                       std::max({size.height, legend.height(), kSmallestPanel / 2}));
  Canvas canvas(panel.br().x + kMargin + legend.width() + kMargin,
                panel.br().y + kFooterHeight + kMargin);
  const cv::Point centering((panel.width - size.width) / 2, (panel.height - size.height) / 2);
  canvas.image(drawn->picture, panel.tl() + centering);
  canvas.frame(panel, kFrame);
  legend.draw(canvas, {panel.br().x + kMargin, panel.y});
  drawScaleBar(canvas, {panel.x, panel.br().y + 30}, drawn->metres_per_pixel,
               view == MapView::Isometric ? " along each axis" : "");
  drawAxes(canvas, drawn->axes, {panel.br().x - 50, panel.br().y + 60});
  return canvas.toPng();
}

}  // namespace csom
