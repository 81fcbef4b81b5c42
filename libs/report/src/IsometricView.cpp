// SPDX-License-Identifier: BSD-3-Clause
// Cubes in isometric projection. Their corners fall onto a lattice of triangles, and each cube
// covers six of them, two a face: so hidden faces are found exactly, triangle by triangle.
#include "IsometricView.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "Canvas.h"
#include "Palette.h"
#include "Shading.h"

namespace csom {

namespace {

constexpr double kLargestEdge = 24;  // of a voxel [pixels]
const double kAcross = std::sqrt(0.5);
const double kUpwards = std::sqrt(1.0 / 6);
const double kForeshortening = std::sqrt(2.0 / 3);  // of all axes

enum class Face : std::uint8_t { Top, Front, Left };

/// A cube for one who stands in the map.
struct Cube {
  std::int32_t right, ahead, up;
};

/// Where a corner falls: cubes along the line of sight (1, 1, −1) share p = right + up and
/// q = ahead + up.
struct LatticePoint {
  std::int32_t p, q;

  double x() const { return kAcross * (p - q); }
  double y() const { return kUpwards * (p + q); }  // upwards
};
LatticePoint project(const Cube& corner) {
  return {corner.right + corner.up, corner.ahead + corner.up};
}
/// Towards the eye.
std::int32_t nearness(const Cube& cube) {
  return cube.up - cube.right - cube.ahead;
}

/// What one sees in one triangle.
struct Facet {
  std::int32_t nearness = std::numeric_limits<std::int32_t>::min();
  std::int32_t height = 0;
  ClassId class_id = kFreeClass;
  Face face = Face::Top;

  bool seen() const { return class_id != kFreeClass; }
};

/// A parallelogram of the lattice, with the corners (p,q) … (p+1,q+1), has two triangles: the one
/// on the side of p and the one on the side of q.
class FacetGrid {
 public:
  FacetGrid(LatticePoint min, LatticePoint max)
      : min_(min),
        width_(max.p - min.p + 1),
        facets_(2 * static_cast<std::size_t>(width_) *
                static_cast<std::size_t>(max.q - min.q + 1)) {}

  void add(const Cube& cube, ClassId k) {
    // The corner that is nearest to the eye lies in the middle of the hexagon.
    const LatticePoint c = project({cube.right, cube.ahead, cube.up + 1});
    cover(c.p, c.q, 0, Face::Top, cube, k);
    cover(c.p, c.q, 1, Face::Top, cube, k);
    cover(c.p, c.q - 1, 1, Face::Front, cube, k);
    cover(c.p - 1, c.q - 1, 0, Face::Front, cube, k);
    cover(c.p - 1, c.q, 0, Face::Left, cube, k);
    cover(c.p - 1, c.q - 1, 1, Face::Left, cube, k);
  }

  /// At a place of the plane, in edges of a cube.
  const Facet& at(double x, double y) const {
    const double sum = y / kUpwards, difference = x / kAcross;
    const double p = (sum + difference) / 2, q = (sum - difference) / 2;
    const auto p0 = static_cast<std::int32_t>(std::floor(p));
    const auto q0 = static_cast<std::int32_t>(std::floor(q));
    static const Facet kNothing;
    if (p0 < min_.p || q0 < min_.q || p0 - min_.p >= width_) return kNothing;
    const std::size_t index = indexOf(p0, q0, p - p0 >= q - q0 ? 0 : 1);
    return index < facets_.size() ? facets_[index] : kNothing;
  }

  const std::vector<Facet>& facets() const { return facets_; }

 private:
  std::size_t indexOf(std::int32_t p, std::int32_t q, int side) const {
    return 2 * (static_cast<std::size_t>(q - min_.q) * static_cast<std::size_t>(width_) +
                static_cast<std::size_t>(p - min_.p)) +
           static_cast<std::size_t>(side);
  }
  void cover(std::int32_t p, std::int32_t q, int side, Face face, const Cube& cube, ClassId k) {
    Facet& facet = facets_[indexOf(p, q, side)];
    if (facet.seen() && facet.nearness >= nearness(cube)) return;
    facet = {nearness(cube), cube.up, k, face};
  }

  LatticePoint min_;
  std::int32_t width_;
  std::vector<Facet> facets_;
};

/// In edges of a cube, y upwards.
struct Extent {
  double left = std::numeric_limits<double>::infinity(), right = -left;
  double bottom = left, top = -left;
  LatticePoint min{std::numeric_limits<std::int32_t>::max(),
                   std::numeric_limits<std::int32_t>::max()};
  LatticePoint max{std::numeric_limits<std::int32_t>::min(),
                   std::numeric_limits<std::int32_t>::min()};

  bool empty() const { return left > right; }
  double width() const { return right - left; }
  double height() const { return top - bottom; }
  void add(const Cube& cube) {
    const LatticePoint c = project({cube.right, cube.ahead, cube.up + 1});
    min = {std::min(min.p, c.p - 1), std::min(min.q, c.q - 1)};
    max = {std::max(max.p, c.p + 1), std::max(max.q, c.q + 1)};
    left = std::min(left, c.x() - kAcross);
    right = std::max(right, c.x() + kAcross);
    bottom = std::min(bottom, c.y() - 2 * kUpwards);
    top = std::max(top, c.y() + 2 * kUpwards);
  }
};

double brightnessOf(const Facet& facet, const CommonRange& heights) {
  const std::array<double, 3> of_face{1.0, 0.66, 0.82};
  return of_face[static_cast<std::size_t>(facet.face)] *
         (0.92 + 0.16 * heights.share(facet.height));
}

cv::Mat paint(const FacetGrid& grid, const Extent& extent, double edge,
              const std::vector<Color>& colors) {
  std::vector<std::int32_t> tops;
  for (const Facet& facet : grid.facets())
    if (facet.seen()) tops.push_back(facet.height);
  const CommonRange heights(std::move(tops));

  const double pixels = edge * Canvas::kScale;
  // Whole pixels of the final picture.
  const auto size = [&](double length) {
    return std::max(1, static_cast<int>(std::ceil(length * edge))) * Canvas::kScale;
  };
  cv::Mat picture(size(extent.height()), size(extent.width()), CV_8UC3,
                  cv::Scalar(kUnknown[2], kUnknown[1], kUnknown[0]));
  for (int row = 0; row < picture.rows; ++row) {
    for (int column = 0; column < picture.cols; ++column) {
      const Facet& facet =
          grid.at(extent.left + (column + 0.5) / pixels, extent.top - (row + 0.5) / pixels);
      if (facet.seen())
        picture.at<cv::Vec3b>(row, column) =
            shade(colors[facet.class_id], brightnessOf(facet, heights));
    }
  }
  return picture;
}

/// Calls visit(cube, class) for all occupied voxels that are drawn, in cubes of `size` voxels a
/// side, several times for a cube if need be.
template <class Visitor>
void forEachCube(const SemanticMap& map, const ViewAxes& axes, const VoxelFilter& filter,
                 std::int32_t size, Visitor&& visit) {
  const auto cubeOf = [&](std::int32_t i) { return i >= 0 ? i / size : -((-i - 1) / size) - 1; };
  map.forEachVoxel([&](const VoxelIndex& index, const DirichletVoxel& voxel) {
    if (voxel.state() != VoxelState::Occupied) return;
    if (filter.highest && filter.up.along(map.grid().center(index)) > *filter.highest) return;
    visit(Cube{cubeOf(axes.right.along(index)), cubeOf(axes.ahead.along(index)),
               cubeOf(axes.up.along(index))},
          voxel.mostLikelyClass());
  });
}

}  // namespace

std::optional<DrawnMap> drawIsometric(const SemanticMap& map, const ViewAxes& axes,
                                      const VoxelFilter& filter, const std::vector<Color>& colors,
                                      int max_pixels) {
  DrawnMap drawn;
  const auto extentAt = [&](std::int32_t size) {
    Extent extent;
    forEachCube(map, axes, filter, size, [&](const Cube& cube, ClassId k) {
      if (filter.hidden.count(k) > 0)
        drawn.left_out.insert(k);
      else
        extent.add(cube);
    });
    return extent;
  };
  Extent extent = extentAt(1);
  if (extent.empty()) return std::nullopt;
  // A cube is never smaller than a pixel.
  const double longest = std::max(extent.width(), extent.height());
  const auto size = static_cast<std::int32_t>(std::ceil(std::max(1.0, longest / max_pixels)));
  if (size > 1) extent = extentAt(size);

  FacetGrid grid(extent.min, extent.max);
  forEachCube(map, axes, filter, size, [&](const Cube& cube, ClassId k) {
    if (filter.hidden.count(k) == 0) grid.add(cube, k);
  });
  const double edge =
      std::min(kLargestEdge, max_pixels / std::max(extent.width(), extent.height()));
  drawn.picture = paint(grid, extent, edge, colors);
  drawn.metres_per_pixel = map.grid().resolution() * size / (edge * kForeshortening);
  const double tilt = kUpwards / kForeshortening, across = kAcross / kForeshortening;
  drawn.axes = {{axes.right.name(), {across, -tilt}},
                {axes.ahead.name(), {-across, -tilt}},
                {axes.up.name(), {0, -1}}};
  for (const Facet& facet : grid.facets())
    if (facet.seen()) ++drawn.seen[facet.class_id];
  return drawn;
}

}  // namespace csom
