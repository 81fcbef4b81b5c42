// SPDX-License-Identifier: BSD-3-Clause
// Spacing, grid and neighbours of points in an image.
#include "PointNeighbours.h"

#include <cmath>
#include <limits>
#include <numeric>

namespace csom::detail {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

/// From a point to the next one to the right (axis 0) or below (axis 1); infinite if there is none.
float gapAfter(const ProjectedPoint& point, const std::vector<ProjectedPoint>& points,
               const PointGrid& grid, Eigen::Index axis) {
  constexpr float kFirstReach = 4;
  for (float reach = kFirstReach; reach < 2 * grid.extent()[axis]; reach *= 2) {
    float gap = kFar;
    Eigen::Vector2f window = Eigen::Vector2f::Constant(reach / 2);
    Eigen::Vector2f centre = point.pixel;
    centre[axis] += reach / 2;
    grid.visit(centre, window, [&](std::size_t i) {
      const Eigen::Vector2f step = points[i].pixel - point.pixel;
      // Within a narrow wedge: rings are curved, so that the next point of a ring lies a little
      // above or below.
      if (step[axis] > 0 && std::abs(step[1 - axis]) <= step[axis] / 2)
        gap = std::min(gap, step[axis]);
    });
    if (gap <= reach) return gap;
  }
  return kFar;
}

/// Cells hold a quarter of a point on average, and are not smaller than pixels.
float cellSize(std::size_t points, cv::Size image_size) {
  const double area = static_cast<double>(image_size.width) * image_size.height;
  const double cells = std::max(1.0, 4.0 * static_cast<double>(points));
  return static_cast<float>(std::max(1.0, std::sqrt(area / cells)));
}

}  // namespace

PointGrid::PointGrid(const std::vector<ProjectedPoint>& points, cv::Size image_size)
    : cell_(cellSize(points.size(), image_size)),
      columns_(static_cast<int>(static_cast<float>(image_size.width) / cell_) + 1),
      rows_(static_cast<int>(static_cast<float>(image_size.height) / cell_) + 1),
      starts_(index(0, rows_) + 1) {
  std::vector<std::size_t> cells;
  cells.reserve(points.size());
  for (const ProjectedPoint& point : points) {
    cells.push_back(index(cellOf(point.pixel.x(), columns_), cellOf(point.pixel.y(), rows_)));
    std::size_t& count = starts_[cells.back() + 1];
    count = std::min(count + 1, kMaxInCell);
  }
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  points_.resize(starts_.back());
  std::vector<std::size_t> ends(starts_.begin(), starts_.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::size_t& end = ends[cells[i]];
    if (end < starts_[cells[i] + 1]) points_[end++] = i;
  }
}

Eigen::Vector2f typicalSpacing(const std::vector<ProjectedPoint>& points, const PointGrid& grid) {
  constexpr std::size_t kSamples = 1000;
  constexpr double kQuantile = 0.9;
  // Every n-th point could be one of the same ring each time: points often come ring by ring.
  constexpr std::size_t kScatter = 2654435761;
  Eigen::Vector2f spacing(0, 0);
  for (const Eigen::Index axis : {0, 1}) {
    std::vector<float> gaps;
    for (std::size_t k = 0; k < std::min(kSamples, points.size()); ++k) {
      const float gap = gapAfter(points[k * kScatter % points.size()], points, grid, axis);
      if (gap < kFar) gaps.push_back(gap);
    }
    if (gaps.empty()) continue;
    const auto place =
        static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(gaps.size() - 1));
    std::nth_element(gaps.begin(), gaps.begin() + place, gaps.end());
    spacing[axis] = gaps[static_cast<std::size_t>(place)];
  }
  return spacing;
}

std::vector<Neighbours> findNeighbours(const std::vector<ProjectedPoint>& points,
                                       cv::Size image_size, float least_reach) {
  // Wider than half a spacing, so that the strip meets every ring that crosses it.
  constexpr float kHalfWidth = 0.8F;
  constexpr float kReach = 1.5F;
  const PointGrid grid(points, image_size);
  const Eigen::Vector2f spacing = typicalSpacing(points, grid);
  Neighbours none;
  none.fill(kNoNeighbour);
  std::vector<Neighbours> neighbours(points.size(), none);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const Eigen::Index axis : {0, 1}) {
      const float reach = std::max(least_reach, kReach * spacing[axis]);
      const float half_width = std::min(reach, kHalfWidth * spacing[1 - axis]);
      Eigen::Vector2f window;
      window[axis] = reach;
      window[1 - axis] = half_width;
      std::array<float, 2> nearest{kFar, kFar};
      grid.visit(points[i].pixel, window, [&](std::size_t j) {
        const Eigen::Vector2f step = points[j].pixel - points[i].pixel;
        const float along = std::abs(step[axis]);
        const float across = std::abs(step[1 - axis]);
        if (along == 0 || along > reach || across > half_width || across > along) return;
        const std::size_t backwards = step[axis] < 0 ? 1 : 0;
        if (along + across >= nearest[backwards]) return;
        nearest[backwards] = along + across;
        neighbours[i][2 * static_cast<std::size_t>(axis) + backwards] = static_cast<int>(j);
      });
    }
  }
  return neighbours;
}

}  // namespace csom::detail
