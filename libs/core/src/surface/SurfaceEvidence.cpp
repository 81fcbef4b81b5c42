// SPDX-License-Identifier: BSD-3-Clause
#include "surface/SurfaceEvidence.h"

#include <csom/core/Kernel.h>

#include <algorithm>
#include <cmath>

namespace csom::detail {

namespace {

/// g_min: the weight of a scan's evidence where it has next to no support.
constexpr float kMinWeight = 0.3F;
/// Rows are left out only if they are outside by more than this.
constexpr float kRounding = 1e-3F;
/// Where the support is less than this, the weight is proportionally less.
constexpr float kFullSupport = 0.3F;

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
         (surface.half_thickness + SurfaceEvidence::kShell) * std::abs(normal);
}

template <class Rows>
CSOM_INLINE void addPlane(const LocalSurface& s, float px, float py, float pz, Rows& votes,
                          Rows& support, Rows& dense) {
  const float inverse_length = 1 / s.length;
  const float shell = s.half_thickness + SurfaceEvidence::kShell;
  const Lanes dx = kCenters.lanes - px;
  const Lanes nx_dx = s.normal.x() * dx;
  const Lanes dx_dx = dx * dx;
  const RowRange ys(py, reachAlong(s.normal.y(), s));
  const RowRange zs(pz, reachAlong(s.normal.z(), s));
  // A row that stays outside the shell, or outside the disc's sphere, receives nothing.
  const float farthest_dx = std::max(std::abs(px - 0.5F), std::abs(kChunkSide - 0.5F - px));
  const float outside_shell = shell + std::abs(s.normal.x()) * farthest_dx + kRounding;
  const float outside_sphere = s.length * s.length + shell * shell + kRounding;
  for (int z = zs.first; z <= zs.last; ++z) {
    const float dz = static_cast<float>(z) + 0.5F - pz;
    for (int y = ys.first; y <= ys.last; ++y) {
      const float dy = static_cast<float>(y) + 0.5F - py;
      const float ny_dy_nz_dz = s.normal.y() * dy + s.normal.z() * dz;
      if (std::abs(ny_dy_nz_dz) > outside_shell || dy * dy + dz * dz > outside_sphere) continue;
      const Lanes along_normal = nx_dx + ny_dy_nz_dz;
      const Lanes squared = dx_dx + (dy * dy + dz * dz) - along_normal * along_normal;
      const Lanes t = squareRoot(squared > 0.0F ? squared : Lanes{}) * inverse_length;
      const Lanes mass = sparseKernel(t);
      const Lanes off = along_normal > 0.0F ? along_normal : -along_normal;
      const auto row = static_cast<std::size_t>(z * kChunkSide + y);
      const Lanes vote = along_normal <= s.half_thickness_of_own_side ? mass : Lanes{};
      votes[row].mass += along_normal >= -s.half_thickness ? vote : Lanes{};
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
      add(static_cast<std::size_t>(z * kChunkSide + y), sparseKernel(t));
    }
  }
}

}  // namespace

SurfaceEvidence::SurfaceEvidence(const Options& options)
    : hit_weight_(static_cast<float>(options.surface.hit_weight)),
      tau_(static_cast<float>(options.surface.support)),
      counter_evidence_(static_cast<float>(options.surface.counter_evidence)),
      free_limit_(static_cast<float>(options.surface.free_limit)) {}

void SurfaceEvidence::reset(const ChunkIndex& chunk) {
  for (Rows* rows : {&votes_, &support_, &dense_, &free_}) rows->fill(Row{});
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
    const float reach = s.reach() + kShell;
    const auto beyond = [&](float v) { return v + reach < 0 || v - reach > kChunkSide; };
    if (beyond(px) || beyond(py) || beyond(pz)) continue;
    const float reach_x = reachAlong(s.normal.x(), s);
    if (px + reach_x < 0 || px - reach_x > kChunkSide) continue;
    switch (s.shape) {
      case LocalSurface::Shape::Plane:
        addPlane(s, px, py, pz, votes_, support_, dense_);
        break;
      case LocalSurface::Shape::Scattered:
        addBall(
            s, px, py, pz, [&](std::size_t row, const Lanes& mass) __attribute__((always_inline)) {
              votes_[row].mass += mass;
              support_[row].mass += mass;
              dense_[row].mass += mass * s.density;
            });
        break;
      case LocalSurface::Shape::Free:
        addBall(
            s, px, py, pz, [&](std::size_t row, const Lanes& mass) __attribute__((always_inline)) {
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

CSOM_EVERY_PROCESSOR
bool SurfaceEvidence::finish() {
  Lanes any{};
  const float enough = 2 * tau_;
  for (std::size_t row = 0; row < votes_.size(); ++row) {
    const Lanes votes = votes_[row].mass;
    const Lanes support = support_[row].mass;
    const Lanes missing = support < enough ? enough - support : Lanes{};
    const Lanes full = 1 - missing / enough;
    const Lanes confidence = support < kFullSupport ? support / kFullSupport : Lanes{} + 1;
    const Lanes weight = (kMinWeight + (1 - kMinWeight) * full) * confidence;
    const Lanes density = support > 0.0F ? dense_[row].mass / support : Lanes{};
    // Where surfaces have support, beams that graze them are no evidence.
    const Lanes unsupported = support < tau_ ? 1 - support / tau_ : Lanes{};
    const Lanes free = free_[row].mass < free_limit_ ? free_[row].mass : Lanes{} + free_limit_;
    votes_[row].mass = weight * votes;
    free_[row].mass =
        weight * counter_evidence_ * (support - votes + density * missing) + unsupported * free;
    any += votes_[row].mass + free_[row].mass;
  }
  float total = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) total += any[lane];
  return total > 0;
}

}  // namespace csom::detail
