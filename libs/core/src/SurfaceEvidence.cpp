// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceEvidence.h"

#include <csom/core/Kernel.h>

#include <algorithm>
#include <cmath>

namespace csom::detail {

namespace {

/// Beyond its thickness a plane speaks against voxels, this far along its normal [voxels]. What is
/// farther off it says nothing about.
constexpr float kShell = 0.5F;

struct alignas(kLaneAlignment) AlignedLanes {
  Lanes lanes;
};
constexpr AlignedLanes kCenters{{0.5F, 1.5F, 2.5F, 3.5F, 4.5F, 5.5F, 6.5F, 7.5F}};

/// Rows along an axis whose centres lie within `reach` of `center`.
struct RowRange {
  RowRange(float center, float reach)
      : first(std::max(0, static_cast<int>(std::ceil(center - reach - 0.5F)))),
        last(std::min(kChunkSide - 1, static_cast<int>(std::floor(center + reach - 0.5F)))) {}
  int first;
  int last;
};

/// Half the edge of the box around the disc or ball that a point's kernel covers.
inline float reachAlong(float normal, const LocalSurface& surface) {
  if (surface.shape != LocalSurface::Shape::Plane) return surface.length;
  return surface.length * std::sqrt(std::max(0.0F, 1 - normal * normal)) +
         (surface.half_thickness + kShell) * std::abs(normal);
}

/// Where there is mass, a reach is at least `length`.
CSOM_INLINE void raise(Lanes& reach, const Lanes& mass, float length) {
  const Lanes here = mass > 0.0F ? Lanes{} + length : Lanes{};
  reach = reach > here ? reach : here;
}

template <class Rows>
CSOM_INLINE void addPlane(const LocalSurface& s, float px, float py, float pz, Rows& votes,
                          Rows& support, Rows& dense, Rows& reach) {
  const float inverse_length = 1 / s.length;
  const float shell = s.half_thickness + kShell;
  const float farthest = s.length + s.half_thickness;
  const Lanes dx = kCenters.lanes - px;
  const Lanes nx_dx = s.normal.x() * dx;
  const Lanes dx_dx = dx * dx;
  const RowRange ys(py, reachAlong(s.normal.y(), s));
  const RowRange zs(pz, reachAlong(s.normal.z(), s));
  for (int z = zs.first; z <= zs.last; ++z) {
    const float dz = static_cast<float>(z) + 0.5F - pz;
    for (int y = ys.first; y <= ys.last; ++y) {
      const float dy = static_cast<float>(y) + 0.5F - py;
      const Lanes along_normal = nx_dx + (s.normal.y() * dy + s.normal.z() * dz);
      const Lanes squared = dx_dx + (dy * dy + dz * dz) - along_normal * along_normal;
      const Lanes t = squareRoot(squared > 0.0F ? squared : Lanes{}) * inverse_length;
      const Lanes mass = t < 1.0F ? sparseKernel(t) : Lanes{};
      const Lanes off = along_normal > 0.0F ? along_normal : -along_normal;
      const auto row = static_cast<std::size_t>(z * kChunkSide + y);
      const Lanes vote = off <= s.half_thickness ? mass : Lanes{};
      votes[row].mass += vote;
      raise(reach[row].mass, vote, farthest);
      const Lanes near = off <= shell ? mass : Lanes{};
      support[row].mass += near;
      dense[row].mass += near * s.density;
    }
  }
}

template <class Add>
CSOM_INLINE void addBall(const LocalSurface& s, float px, float py, float pz, Add&& add) {
  const float inverse_length = 1 / s.length;
  const Lanes dx = kCenters.lanes - px;
  const Lanes dx_dx = dx * dx;
  const RowRange ys(py, s.length);
  const RowRange zs(pz, s.length);
  for (int z = zs.first; z <= zs.last; ++z) {
    const float dz = static_cast<float>(z) + 0.5F - pz;
    for (int y = ys.first; y <= ys.last; ++y) {
      const float dy = static_cast<float>(y) + 0.5F - py;
      const Lanes t = squareRoot(dx_dx + (dy * dy + dz * dz)) * inverse_length;
      add(static_cast<std::size_t>(z * kChunkSide + y), t < 1.0F ? sparseKernel(t) : Lanes{});
    }
  }
}

}  // namespace

void SurfaceEvidence::reset(const ChunkIndex& chunk) {
  for (Rows* rows : {&votes_, &support_, &dense_, &free_, &reach_}) rows->fill(Row{});
  x_ = fixedPoint(chunk.x * kChunkSide);
  y_ = fixedPoint(chunk.y * kChunkSide);
  z_ = fixedPoint(chunk.z * kChunkSide);
}

CSOM_EVERY_PROCESSOR
void SurfaceEvidence::add(const PointColumns& points, const std::vector<LocalSurface>& surfaces,
                          std::uint32_t begin, std::uint32_t end) {
  constexpr float kVoxels = 1.0F / kFixedPointVoxel;
  for (std::uint32_t p = begin; p < end; ++p) {
    const LocalSurface& s = surfaces[p];
    const auto inVoxels = [](FixedPoint offset) {
      return static_cast<float>(static_cast<std::int32_t>(offset)) * kVoxels;
    };
    const float px = inVoxels(points.x[p] - x_);
    const float py = inVoxels(points.y[p] - y_);
    const float pz = inVoxels(points.z[p] - z_);
    const float reach_x = reachAlong(s.normal.x(), s);
    if (px + reach_x < 0 || px - reach_x > kChunkSide) continue;
    switch (s.shape) {
      case LocalSurface::Shape::Plane:
        addPlane(s, px, py, pz, votes_, support_, dense_, reach_);
        break;
      case LocalSurface::Shape::Scattered:
        addBall(s, px, py, pz,
                [&](std::size_t row, const Lanes& mass) __attribute__((always_inline)) {
                  votes_[row].mass += mass;
                  support_[row].mass += mass;
                  dense_[row].mass += mass * s.density;
                  raise(reach_[row].mass, mass, s.length);
                });
        break;
      case LocalSurface::Shape::Free:
        addBall(s, px, py, pz,
                [&](std::size_t row, const Lanes& mass) __attribute__((always_inline)) {
                  free_[row].mass += mass;
                });
        continue;
    }
    const auto inside = [](float v) { return v >= 0 && v < kChunkSide; };
    if (inside(px) && inside(py) && inside(pz)) {
      const auto row = static_cast<std::size_t>(pz) * kLanes + static_cast<std::size_t>(py);
      const auto lane = static_cast<std::size_t>(px);
      votes_[row].mass[lane] += hit_weight_;
      support_[row].mass[lane] += hit_weight_;
      dense_[row].mass[lane] += hit_weight_ * s.density;
    }
  }
}

}  // namespace csom::detail
