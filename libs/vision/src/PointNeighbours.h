// SPDX-License-Identifier: BSD-3-Clause
// Points in an image by place: how far they are apart, and which are next to which.
#pragma once

#include <csom/vision/Visibility.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace csom::detail {

/// Finds the points around a pixel.
class PointGrid {
 public:
  PointGrid(const std::vector<ProjectedPoint>& points, cv::Size image_size);

  /// Width and height of all cells [px].
  Eigen::Vector2f extent() const {
    return cell_ * Eigen::Vector2f(static_cast<float>(columns_), static_cast<float>(rows_));
  }

  /// Calls visit(index) for the points of all cells that a window touches: those in it and some
  /// more. Of a cell with very many points the last are not visited, so that piles of points (a
  /// sensor's invalid returns are often one point) cost no more time than others.
  template <class Visit>
  void visit(const Eigen::Vector2f& centre, const Eigen::Vector2f& half_size, Visit&& visit) const {
    const int left = cellOf(centre.x() - half_size.x(), columns_);
    const int right = cellOf(centre.x() + half_size.x(), columns_);
    const int bottom = cellOf(centre.y() + half_size.y(), rows_);
    for (int row = cellOf(centre.y() - half_size.y(), rows_); row <= bottom; ++row) {
      const std::size_t first = starts_[index(left, row)];
      const std::size_t end = starts_[index(right, row) + 1];
      for (std::size_t i = first; i < end; ++i) visit(points_[i]);
    }
  }

 private:
  static constexpr std::size_t kMaxInCell = 64;

  int cellOf(float coordinate, int cells) const {
    return std::clamp(static_cast<int>((coordinate + 0.5F) / cell_), 0, cells - 1);
  }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }

  float cell_;  ///< edge of a cell [px]
  int columns_;
  int rows_;
  std::vector<std::size_t> starts_;  ///< by cell, of its points in points_
  std::vector<std::size_t> points_;
};

/// Pixels from a point to the next one to the right and to the next one below: nine out of ten
/// points have one so near. 0 if there is none. LiDARs are dense along a ring and sparse across.
Eigen::Vector2f typicalSpacing(const std::vector<ProjectedPoint>& points, const PointGrid& grid);

/// Right, left, down, up.
constexpr std::size_t kDirections = 4;
/// 0 along x, 1 along y.
constexpr Eigen::Index axisOf(std::size_t direction) {
  return static_cast<Eigen::Index>(direction / 2);
}
constexpr std::size_t opposite(std::size_t direction) {
  return direction ^ 1;
}
/// Of the coordinate in this direction.
constexpr float signOf(std::size_t direction) {
  return direction % 2 == 0 ? 1.0F : -1.0F;
}

constexpr int kNoNeighbour = -1;
using Neighbours = std::array<int, kDirections>;

/// The next point in each direction: in the quarter of the plane around it and in a strip about as
/// wide as points are apart, not farther than one and a half spacings or `least_reach`.
std::vector<Neighbours> findNeighbours(const std::vector<ProjectedPoint>& points,
                                       cv::Size image_size, float least_reach);

}  // namespace csom::detail
