// SPDX-License-Identifier: BSD-3-Clause
// Points that nearer points surround are hidden.
#include <csom/vision/Visibility.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "PointNeighbours.h"

namespace csom {
namespace {

using Eigen::Vector2f;

/// What covers a pixel, as far as the points around it can tell: the nearest one in each quadrant.
class Cover {
 public:
  explicit Cover(const Vector2f& window) : window_(window) { distances_.fill(kNone); }

  void add(const Vector2f& offset, float depth) {
    // As a share of the window, but for a factor that is the same for all.
    const float distance = std::abs(offset.x()) * window_.y() + std::abs(offset.y()) * window_.x();
    const std::size_t quadrant = (offset.x() > 0 ? 1U : 0U) + (offset.y() > 0 ? 2U : 0U);
    if (distance >= distances_[quadrant]) return;
    distances_[quadrant] = distance;
    depths_[quadrant] = depth;
  }

  bool hides(float depth) const {
    for (const float distance : distances_) {
      if (distance == kNone) return false;
    }
    const auto [nearest, farthest] = std::minmax_element(depths_.begin(), depths_.end());
    // Else they may be two things with a gap between them.
    return *farthest - *nearest < depth - *farthest;
  }

 private:
  static constexpr float kNone = std::numeric_limits<float>::infinity();

  Vector2f window_;
  std::array<float, 4> distances_;
  std::array<float, 4> depths_{};
};

}  // namespace

std::vector<bool> hiddenPoints(const std::vector<ProjectedPoint>& points, cv::Size image_size,
                               double margin) {
  const detail::PointGrid grid(points, image_size);
  const Vector2f window = detail::typicalSpacing(points, grid);
  std::vector<bool> hidden(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float near = points[i].depth - static_cast<float>(margin);
    Cover cover(window);
    grid.visit(points[i].pixel, window, [&](std::size_t j) {
      if (points[j].depth >= near) return;
      const Vector2f offset = points[j].pixel - points[i].pixel;
      if ((offset.array().abs() <= window.array()).all()) cover.add(offset, points[j].depth);
    });
    hidden[i] = cover.hides(points[i].depth);
  }
  return hidden;
}

}  // namespace csom
