// SPDX-License-Identifier: BSD-3-Clause
// Labels that have bled over a jump of the depth, told from those that belong there.
#include <csom/vision/Visibility.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "LabelBorder.h"
#include "PointNeighbours.h"

namespace csom {
namespace {

using detail::axisOf;
using detail::kDirections;
using detail::kNoNeighbour;
using detail::Neighbours;
using detail::opposite;

/// What labels of whole pixels leave open about where a border runs [px]. Less loses fewer points,
/// more labels fewer wrongly.
constexpr float kBorderUncertainty = 0.09F;

/// Sets of points that grow together.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parents_(size) {
    std::iota(parents_.begin(), parents_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void join(std::size_t i, std::size_t j) {
    i = find(i);
    j = find(j);
    parents_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<std::size_t> parents_;
};

/// What the points around a run of points say about its label.
struct Evidence {
  int confirmations = 0;
  int contradictions = 0;

  bool confirms() const { return confirmations > 0 && confirmations >= contradictions; }
};

class EdgeFinder {
 public:
  EdgeFinder(const std::vector<ProjectedPoint>& points, const cv::Mat& classes, float edge_margin,
             float margin)
      : points_(points),
        classes_(classes),
        edge_margin_(edge_margin),
        margin_(margin),
        neighbours_(detail::findNeighbours(points, classes.size(), edge_margin)),
        steps_(points.size()) {
    labels_.reserve(points.size());
    for (const ProjectedPoint& point : points) labels_.push_back(labelAt(point.pixel));
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t direction = 0; direction < kDirections; ++direction)
        steps_[i][direction] = stepFrom(i, direction);
    }
  }

  std::vector<bool> find() const;

 private:
  /// From a point to its neighbour: on along a surface, or to another one.
  enum class Step : std::uint8_t { None, OnSurface, Jump };

  std::uint16_t labelAt(const Eigen::Vector2f& pixel) const {
    const int x = static_cast<int>(std::floor(pixel.x() + 0.5F));
    const int y = static_cast<int>(std::floor(pixel.y() + 0.5F));
    return classes_.at<std::uint16_t>(std::clamp(y, 0, classes_.rows - 1),
                                      std::clamp(x, 0, classes_.cols - 1));
  }
  float depth(std::size_t i) const { return points_[i].depth; }
  float pixelsBetween(std::size_t i, std::size_t j, std::size_t direction) const {
    const Eigen::Index axis = axisOf(direction);
    return std::abs(points_[j].pixel[axis] - points_[i].pixel[axis]);
  }
  /// Change of 1/depth per pixel, which is the same everywhere on a plane.
  float slope(std::size_t from, std::size_t to, std::size_t direction) const {
    return (1 / depth(to) - 1 / depth(from)) / pixelsBetween(from, to, direction);
  }
  bool recedesLike(float slope, int from, int to, std::size_t direction) const;
  Step stepFrom(std::size_t i, std::size_t direction) const;
  bool hasBorderWithin(std::size_t i, std::size_t direction) const;
  bool sharesLabelOverJump(std::size_t i, std::size_t direction) const;

  const std::vector<ProjectedPoint>& points_;
  const cv::Mat& classes_;
  float edge_margin_;
  float margin_;
  std::vector<Neighbours> neighbours_;
  std::vector<std::array<Step, kDirections>> steps_;
  std::vector<std::uint16_t> labels_;
};

/// True if 1/depth changes from one point to the other at no less than half the rate `slope`.
bool EdgeFinder::recedesLike(float slope_of_step, int from, int to, std::size_t direction) const {
  constexpr float kSimilar = 0.5F;
  if (from == kNoNeighbour || to == kNoNeighbour) return false;
  const float other =
      slope(static_cast<std::size_t>(from), static_cast<std::size_t>(to), direction);
  return other * slope_of_step > 0 && std::abs(other) >= kSimilar * std::abs(slope_of_step);
}

EdgeFinder::Step EdgeFinder::stepFrom(std::size_t i, std::size_t direction) const {
  const int next = neighbours_[i][direction];
  if (next == kNoNeighbour) return Step::None;
  const auto j = static_cast<std::size_t>(next);
  if (std::abs(depth(i) - depth(j)) <= margin_) return Step::OnSurface;
  const int before = neighbours_[i][opposite(direction)];
  const int after = neighbours_[j][direction];
  // Without another point on the nearer side, it may be a surface that recedes from there.
  if ((depth(j) < depth(i) ? after : before) == kNoNeighbour) return Step::OnSurface;
  const float step = slope(i, j, direction);
  const bool recedes = recedesLike(step, before, static_cast<int>(i), direction) ||
                       recedesLike(step, next, after, direction);
  return recedes ? Step::OnSurface : Step::Jump;
}

bool EdgeFinder::hasBorderWithin(std::size_t i, std::size_t direction) const {
  for (float pixels = 1; pixels <= std::max(1.0F, edge_margin_); ++pixels) {
    Eigen::Vector2f pixel = points_[i].pixel;
    pixel[axisOf(direction)] += detail::signOf(direction) * pixels;
    if (labelAt(pixel) != labels_[i]) return true;
  }
  return false;
}

/// True if a jump of the depth is near in this direction, and the label is the same beyond it: on
/// one of its sides the label may be wrong.
bool EdgeFinder::sharesLabelOverJump(std::size_t i, std::size_t direction) const {
  for (std::size_t at = i;;) {
    const int next = neighbours_[at][direction];
    if (next == kNoNeighbour) return false;
    const auto j = static_cast<std::size_t>(next);
    if (labels_[j] != labels_[i]) return false;
    if (steps_[at][direction] == Step::Jump) {
      // Behind, the strip with a wrong label is as wide as points are apart. In front there is
      // none: the label can only be wrong where the border was drawn too far inside.
      return depth(j) < depth(at) || hasBorderWithin(i, opposite(direction));
    }
    if (pixelsBetween(i, j, direction) > edge_margin_) return false;
    at = j;
  }
}

/// Points that share their label over a jump form runs. The label of a run is its own if the
/// surface around it has it too, and has bled over the jump if the surface goes on with other
/// labels.
std::vector<bool> EdgeFinder::find() const {
  std::vector<bool> doubtful(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    for (std::size_t direction = 0; direction < kDirections && !doubtful[i]; ++direction)
      doubtful[i] = sharesLabelOverJump(i, direction);
  }
  const auto forEachStepOnSurface = [&](auto&& visit) {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      for (std::size_t direction = 0; direction < kDirections && doubtful[i]; ++direction) {
        if (steps_[i][direction] == Step::OnSurface)
          visit(i, static_cast<std::size_t>(neighbours_[i][direction]));
      }
    }
  };
  const auto inOneRun = [&](std::size_t i, std::size_t j) {
    return doubtful[j] && labels_[i] == labels_[j];
  };
  DisjointSets runs(points_.size());
  forEachStepOnSurface([&](std::size_t i, std::size_t j) {
    if (inOneRun(i, j)) runs.join(i, j);
  });
  std::vector<Evidence> evidence(points_.size());  // by run
  forEachStepOnSurface([&](std::size_t i, std::size_t j) {
    if (inOneRun(i, j)) return;
    Evidence& of_run = evidence[runs.find(i)];
    ++(labels_[i] == labels_[j] ? of_run.confirmations : of_run.contradictions);
  });
  std::vector<bool> has_bled(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i)
    has_bled[i] = doubtful[i] && !evidence[runs.find(i)].confirms();
  return has_bled;
}

}  // namespace

std::vector<bool> pointsAtEdges(const std::vector<ProjectedPoint>& points, const cv::Mat& classes,
                                double edge_margin, double margin) {
  if (points.empty()) return {};
  std::vector<bool> at_edge =
      EdgeFinder(points, classes, static_cast<float>(edge_margin), static_cast<float>(margin))
          .find();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!at_edge[i])
      at_edge[i] = detail::distanceToBorder(classes, points[i].pixel) < kBorderUncertainty;
  }
  return at_edge;
}

}  // namespace csom
