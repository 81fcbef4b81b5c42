// SPDX-License-Identifier: BSD-3-Clause
#include "image/FacePainter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "util/Parallel.h"

namespace csom::detail {

namespace {

/// Quadrilaterals of fewer pixels along both axes are drawn as boxes: at most so much too large.
constexpr int kBoxPixels = 8;
/// Beams whose directions differ more, as tangent, are not adjacent.
constexpr float kWidest = 0.25F;
/// What ended nearer to the sensor passes no pixel: inverse depth [1/m].
constexpr float kNearest = 1e6F;
/// Gaps of so many pixels are closed.
constexpr std::size_t kGapPixels = 4;

}  // namespace

void BeamProjections::compute(const ImageBeams& beams, int threads) {
  face.resize(beams.size());
  for (std::vector<float>* numbers : {&u, &v, &inverse}) numbers->resize(beams.size());
  for (std::vector<BeamId>& of_face : quads) of_face.clear();
  parallelRanges(beams.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::array<float, 3> p{beams.x[i], beams.y[i], beams.z[i]};
      const int own = CubeGrid::faceOf(p[0], p[1], p[2]);
      const FaceAxes axes(own);
      const float depth = std::abs(p[axes.depth]);
      face[i] = static_cast<std::uint8_t>(own);
      u[i] = p[axes.u] / depth;
      v[i] = p[axes.v] / depth;
      inverse[i] = 1 / depth;
    }
  });
  const BeamNeighbours& n = beams.neighbours;
  for (std::size_t a = 0; a < beams.size(); ++a) {
    if (n.next[a] == kNoBeam || n.above[a] == kNoBeam) continue;
    const auto b = static_cast<std::size_t>(n.next[a]);
    const auto c = static_cast<std::size_t>(n.above[a]);
    if (n.next[c] == kNoBeam) continue;
    const auto d = static_cast<std::size_t>(n.next[c]);
    unsigned shows_on = 0;
    for (const std::size_t corner : {a, b, c, d}) shows_on |= 1U << face[corner];
    for (std::size_t i = 0; i < quads.size(); ++i)
      if ((shows_on >> i & 1U) != 0) quads[i].push_back(static_cast<BeamId>(a));
  }
}

/// Inverse depth over a face: that of a plane at its nearest within half a pixel, between the
/// corners' own.
struct FacePainter::Plane {
  Projection corner;
  float along_u, along_v, margin;
  float farthest, nearest;

  float at(float u, float v) const {
    const float inverse =
        corner.inverse + (along_u * (u - corner.u) + along_v * (v - corner.v)) + margin;
    return std::min(std::max(inverse, farthest), nearest);
  }
};

FacePainter::Plane FacePainter::flat(float inverse) {
  return {{0, 0, inverse}, 0, 0, 0, inverse, inverse};
}

void FacePainter::run() {
  out_.empty = true;
  const BeamNeighbours& n = beams_.neighbours;
  for (const BeamId quad : projections_.quads[static_cast<std::size_t>(face_)]) {
    const auto a = static_cast<std::size_t>(quad);
    const auto above = static_cast<std::size_t>(n.above[a]);
    draw({a, static_cast<std::size_t>(n.next[a]), above, static_cast<std::size_t>(n.next[above])});
  }
  if (out_.empty) return;
  out_.spacing = static_cast<float>(spacings_ / drawings_);
  closeGaps();
  buildPyramids();
}

/// Nothing is seen of a beam behind the plane of the sensor: its inverse depth is not positive.
FacePainter::Projection FacePainter::project(std::size_t beam) const {
  if (projections_.face[beam] == face_)
    return {projections_.u[beam], projections_.v[beam], projections_.inverse[beam]};
  const std::array<float, 3> p{beams_.x[beam], beams_.y[beam], beams_.z[beam]};
  const float depth = axes_.positive ? p[axes_.depth] : -p[axes_.depth];
  if (!(depth > 0)) return {0, 0, 0};
  return {p[axes_.u] / depth, p[axes_.v] / depth, 1 / depth};
}

struct FacePainter::Bounds {
  float min_u, max_u, min_v, max_v;
  float farthest, nearest;  ///< inverse depth
};

template <std::size_t N>
FacePainter::Bounds FacePainter::boundsOf(const std::array<Projection, N>& corners) {
  const Projection& first = corners.front();
  Bounds b{first.u, first.u, first.v, first.v, first.inverse, first.inverse};
  for (const Projection& corner : corners) {
    b.min_u = std::min(b.min_u, corner.u);
    b.max_u = std::max(b.max_u, corner.u);
    b.min_v = std::min(b.min_v, corner.v);
    b.max_v = std::max(b.max_v, corner.v);
    b.farthest = std::min(b.farthest, corner.inverse);
    b.nearest = std::max(b.nearest, corner.inverse);
  }
  return b;
}

FacePainter::PixelBox FacePainter::pixelsOf(const Bounds& bounds) const {
  return {grid_.firstPixel(bounds.min_u), grid_.lastPixel(bounds.max_u),
          grid_.firstPixel(bounds.min_v), grid_.lastPixel(bounds.max_v)};
}

void FacePainter::draw(const Corners& corners) {
  const std::array<Projection, 4> at{project(corners[0]), project(corners[1]), project(corners[2]),
                                     project(corners[3])};
  const Bounds b = boundsOf(at);
  if (!(b.farthest > 0) || !(b.nearest < kNearest)) return;
  const float spacing = std::max(b.max_u - b.min_u, b.max_v - b.min_v);
  const float off_centre =
      std::max({b.min_u * b.min_u, b.max_u * b.max_u, b.min_v * b.min_v, b.max_v * b.max_v});
  if (!(spacing < kWidest * (1 + off_centre))) return;
  if (b.max_u < -1 || b.min_u > 1 || b.max_v < -1 || b.min_v > 1) return;
  const PixelBox box = pixelsOf(b);
  prepare(box);
  spacings_ += spacing;
  ++drawings_;
  const bool is_surface = isSurface(corners);
  const bool is_small =
      box.last_u - box.first_u < kBoxPixels && box.last_v - box.first_v < kBoxPixels;
  if (is_small && !is_surface) {
    fill(box, flat(b.nearest));
    return;
  }
  for (const Triangle& triangle : {Triangle{at[0], at[1], at[2]}, Triangle{at[1], at[3], at[2]}}) {
    const Plane plane = is_surface ? planeThrough(triangle) : flat(b.nearest);
    if (is_small)
      fill(box, plane);
    else
      fillTriangle(triangle, plane);
  }
}

/// Whether all four sides are.
bool FacePainter::isSurface(const Corners& corners) const {
  return facets_.to_next[corners[0]] != Facets::kNone &&
         facets_.to_next[corners[2]] != Facets::kNone &&
         facets_.to_above[corners[0]] != Facets::kNone &&
         facets_.to_above[corners[1]] != Facets::kNone &&
         beams_.neighbours.above[corners[1]] == static_cast<BeamId>(corners[3]);
}

/// Twice the area, positive if the corners turn from u to v.
float FacePainter::areaOf(const Triangle& t) {
  return (t[1].u - t[0].u) * (t[2].v - t[0].v) - (t[2].u - t[0].u) * (t[1].v - t[0].v);
}

FacePainter::Plane FacePainter::planeThrough(const Triangle& t) const {
  const Bounds b = boundsOf(t);
  const float area = areaOf(t);
  if (area == 0) return flat(b.nearest);
  const float to_b = t[1].inverse - t[0].inverse;
  const float to_c = t[2].inverse - t[0].inverse;
  const float along_u = (to_b * (t[2].v - t[0].v) - to_c * (t[1].v - t[0].v)) / area;
  const float along_v = (to_c * (t[1].u - t[0].u) - to_b * (t[2].u - t[0].u)) / area;
  const float margin = (std::abs(along_u) + std::abs(along_v)) / static_cast<float>(side_);
  return {t[0], along_u, along_v, margin, b.farthest, b.nearest};
}

void FacePainter::fill(const PixelBox& box, const Plane& plane) {
  for (int v = box.first_v; v <= box.last_v; ++v)
    for (int u = box.first_u; u <= box.last_u; ++u)
      put(u, v, plane.at(grid_.centreOf(u), grid_.centreOf(v)));
}

/// Each pixel whose centre lies in it, its border included.
void FacePainter::fillTriangle(const Triangle& t, const Plane& plane) {
  const PixelBox box = pixelsOf(boundsOf(t));
  const float turn = areaOf(t) > 0 ? 1.0F : -1.0F;
  const auto isInside = [&](const Projection& from, const Projection& to, float u, float v) {
    return ((to.u - from.u) * (v - from.v) - (to.v - from.v) * (u - from.u)) * turn >= 0;
  };
  for (int v = box.first_v; v <= box.last_v; ++v) {
    const float at_v = grid_.centreOf(v);
    for (int u = box.first_u; u <= box.last_u; ++u) {
      const float at_u = grid_.centreOf(u);
      if (isInside(t[0], t[1], at_u, at_v) && isInside(t[1], t[2], at_u, at_v) &&
          isInside(t[2], t[0], at_u, at_v))
        put(u, v, plane.at(at_u, at_v));
    }
  }
}

/// Makes room when the first quadrilateral comes, and notes where they lie.
void FacePainter::prepare(const PixelBox& box) {
  if (out_.empty) {
    out_.empty = false;
    side_ = static_cast<std::size_t>(grid_.side());
    out_.nearest.reset(grid_.side(), grid_.levels() - 1);
    image_ = out_.nearest.level(0);
  }
  const PixelRectangle pixels{
      static_cast<std::size_t>(box.first_u), static_cast<std::size_t>(box.last_u) + 1,
      static_cast<std::size_t>(box.first_v), static_cast<std::size_t>(box.last_v) + 1};
  drawn_.add(pixels);
}

void FacePainter::put(int u, int v, float inverse) {
  float& pixel = image_[static_cast<std::size_t>(v) * side_ + static_cast<std::size_t>(u)];
  pixel = std::max(pixel, inverse);
}

namespace {

void closeLine(const float* before, std::size_t stride, std::size_t size, float* pixels,
               std::size_t pixel_stride) {
  std::size_t last_drawn = size;  // none yet
  for (std::size_t i = 0; i < size; ++i) {
    const float end = before[i * stride];
    if (end == DepthFace::kNothing) continue;
    if (last_drawn + 1 < i && i - last_drawn <= kGapPixels + 1) {
      const float inverse = std::max(end, before[last_drawn * stride]);
      for (std::size_t gap = last_drawn + 1; gap < i; ++gap)
        pixels[gap * pixel_stride] = std::max(pixels[gap * pixel_stride], inverse);
    }
    last_drawn = i;
  }
}

}  // namespace

/// Gives gaps of up to kGapPixels between drawn pixels of a row or a column the depth of the nearer
/// end: single beams that got lost, and slivers where beams of two rows do not face.
void FacePainter::closeGaps() {
  out_.nearest.willWrite(0, drawn_);
  const std::size_t width = drawn_.end_u - drawn_.first_u;
  const std::size_t height = drawn_.end_v - drawn_.first_v;
  float* const first = image_ + drawn_.first_v * side_ + drawn_.first_u;
  std::vector<float> before(width * height);
  for (std::size_t v = 0; v < height; ++v)
    std::copy_n(first + v * side_, width, before.data() + v * width);
  for (std::size_t v = 0; v < height; ++v)
    closeLine(before.data() + v * width, 1, width, first + v * side_, 1);
  for (std::size_t u = 0; u < width; ++u)
    closeLine(before.data() + u, width, height, first + u, side_);
}

void FacePainter::buildPyramids() {
  for (int level = 1; level < grid_.levels() - 1; ++level) slide(level);
  out_.farthest.reset(grid_.side(), grid_.levels());
  for (int level = 1; level < grid_.levels(); ++level) shrink(level);
}

/// Makes each pixel of a level of four of the level below it, where anything was drawn.
void FacePainter::shrink(int level) {
  ImageLevels& levels = out_.farthest;
  const std::size_t side = levels.sideOf(level);
  const bool of_image = level == 1;
  const float* const from = of_image ? image_ : levels.level(level - 1);
  float* const to = levels.level(level);
  const auto drawn = [of_image](float inverse) {
    constexpr float kNothing = std::numeric_limits<float>::infinity();
    return of_image && inverse == DepthFace::kNothing ? kNothing : inverse;
  };
  const PixelRectangle pixels{drawn_.first_u >> level, ((drawn_.end_u - 1) >> level) + 1,
                              drawn_.first_v >> level, ((drawn_.end_v - 1) >> level) + 1};
  levels.willWrite(level, pixels);
  for (std::size_t v = pixels.first_v; v < pixels.end_v; ++v) {
    const float* const upper = from + 4 * v * side;
    const float* const lower = upper + 2 * side;
    for (std::size_t u = pixels.first_u; u < pixels.end_u; ++u)
      to[v * side + u] = std::min(std::min(drawn(upper[2 * u]), drawn(upper[2 * u + 1])),
                                  std::min(drawn(lower[2 * u]), drawn(lower[2 * u + 1])));
  }
}

namespace {

/// The nearest of two squares, negative if either of them is.
float nearestOf(float a, float b) {
  const float nearest = std::max(std::abs(a), std::abs(b));
  return std::signbit(a) || std::signbit(b) ? -nearest : nearest;
}

}  // namespace

/// Makes each square of a level of four of the level below it, where anything was drawn.
void FacePainter::slide(int level) {
  const std::size_t half = std::size_t{1} << (level - 1);
  const float* const from = out_.nearest.level(level - 1);
  float* const to = out_.nearest.level(level);
  const auto first = [&](std::size_t pixel) { return pixel - std::min(pixel, 2 * half - 1); };
  const PixelRectangle pixels{first(drawn_.first_u), drawn_.end_u, first(drawn_.first_v),
                              drawn_.end_v};
  out_.nearest.willWrite(level, pixels);
  // Beyond the image is nothing that a square could hold: the square itself instead.
  const std::size_t both_u = std::min(drawn_.end_u, side_ - std::min(side_, half));
  for (std::size_t v = pixels.first_v; v < pixels.end_v; ++v) {
    const float* const upper = from + v * side_;
    const float* const lower = v + half < side_ ? upper + half * side_ : upper;
    float* const row = to + v * side_;
    std::size_t u = pixels.first_u;
    for (; u < both_u; ++u)
      row[u] =
          nearestOf(nearestOf(upper[u], upper[u + half]), nearestOf(lower[u], lower[u + half]));
    for (; u < drawn_.end_u; ++u) row[u] = nearestOf(upper[u], lower[u]);
  }
}

}  // namespace csom::detail
