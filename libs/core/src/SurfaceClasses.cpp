// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceClasses.h"

#include <csom/core/Kernel.h>

#include <algorithm>
#include <array>

#include "FixedPointLanes.h"

namespace csom::detail {

namespace {

/// Hits side by side, and how far each reaches [voxels].
struct HitColumns {
  const FixedPoint* x;
  const FixedPoint* y;
  const FixedPoint* z;
  const float* reach;
};

CSOM_EVERY_PROCESSOR
std::size_t selectNear(const HitColumns& hits, std::size_t size, const BlockPlace& block,
                       float length, std::uint32_t* selected) {
  const FixedPoint middle = block.edge / 2;
  const FixedPoint half = middle - kFixedPointVoxel / 2;  // to the outermost voxel centres
  std::size_t found = 0;
  for (std::size_t first = 0; first < size; first += kLanes) {
    const Lanes dx = distanceBeyond(load(hits.x + first), block.x + middle, half);
    const Lanes dy = distanceBeyond(load(hits.y + first), block.y + middle, half);
    const Lanes dz = distanceBeyond(load(hits.z + first), block.z + middle, half);
    const Lanes own = load(hits.reach + first);
    const Lanes limit = (own > length ? own : Lanes{} + length) * kUnits;
    const IntLanes near = dx * dx + dy * dy + dz * dz < limit * limit;
    const std::size_t count = std::min(kLanes, size - first);
    for (std::size_t lane = 0; lane < count; ++lane) {
      selected[found] = static_cast<std::uint32_t>(first + lane);
      found += near[lane] != 0 ? 1 : 0;
    }
  }
  return found;
}

template <class KernelFunction>
CSOM_INLINE void massOf(KernelFunction kernel, const HitColumns& hits, const std::uint32_t* batch,
                        std::size_t size, const LaneGroup& group, const BlockPlace& block,
                        float length, Lanes* masses) {
  const WordLanes x = group.x + block.x;
  const WordLanes y = group.y + block.y;
  const WordLanes z = group.z + block.z;
  for (std::size_t i = 0; i < size; ++i) {
    const std::uint32_t p = batch[i];
    const Lanes dx = toFloat(x - hits.x[p]);
    const Lanes dy = toFloat(y - hits.y[p]);
    const Lanes dz = toFloat(z - hits.z[p]);
    const float inverse_length = 1.0F / std::max(length, hits.reach[p]) / kUnits;
    const Lanes t = squareRoot(dx * dx + dy * dy + dz * dz) * inverse_length;
    masses[i] = t < 1.0F ? kernel(t) : Lanes{};
  }
}

CSOM_EVERY_PROCESSOR
void sparseMass(const HitColumns& hits, const std::uint32_t* batch, std::size_t size,
                const LaneGroup& group, const BlockPlace& block, float length, Lanes* masses) {
  massOf(
      [](const Lanes& t) __attribute__((always_inline)) { return sparseKernel(t); }, hits, batch,
      size, group, block, length, masses);
}

CSOM_EVERY_PROCESSOR
void linearMass(const HitColumns& hits, const std::uint32_t* batch, std::size_t size,
                const LaneGroup& group, const BlockPlace& block, float length, Lanes* masses) {
  massOf(
      [](const Lanes& t) __attribute__((always_inline)) { return linearKernel(t); }, hits, batch,
      size, group, block, length, masses);
}

}  // namespace

void SurfaceClasses::clear() {
  size_ = 0;
  label_.clear();
  scores_.clear();
}

void SurfaceClasses::add(const PointColumns& points, const std::vector<LocalSurface>& surfaces,
                         const std::vector<float>& scores, std::uint32_t begin, std::uint32_t end) {
  const std::size_t most = size_ + (end - begin) + kLanes;
  if (x_.size() < most) {
    for (std::vector<FixedPoint>* axis : {&x_, &y_, &z_}) axis->resize(2 * most);
    reach_.resize(2 * most);
  }
  const std::size_t classes = scores.size() / points.label.size();
  for (std::uint32_t p = begin; p < end; ++p) {
    if (surfaces[p].shape == LocalSurface::Shape::Free) continue;
    x_[size_] = points.x[p];
    y_[size_] = points.y[p];
    z_[size_] = points.z[p];
    reach_[size_] = surfaces[p].reach();
    label_.push_back(points.label[p]);
    const auto row = scores.begin() + static_cast<std::ptrdiff_t>(p * classes);
    scores_.insert(scores_.end(), row, row + static_cast<std::ptrdiff_t>(classes));
    ++size_;
  }
}

void SurfaceClasses::select(const BlockPlace& block, float length) {
  block_ = block;
  length_ = length;
  selected_.resize(size_);
  selected_.resize(selectNear({x_.data(), y_.data(), z_.data(), reach_.data()}, size_, block,
                              length, selected_.data()));
}

std::optional<ClassId> SurfaceClasses::onlyClass() const {
  if (!scores_.empty() || selected_.empty()) return std::nullopt;
  const ClassId first = label_[selected_.front()];
  const bool same = std::all_of(selected_.begin(), selected_.end(),
                                [&](std::uint32_t p) { return label_[p] == first; });
  return same ? std::optional<ClassId>(first) : std::nullopt;
}

const std::vector<ClassId>& SurfaceClasses::sum(const LaneGroup& group) {
  sums_.reset();
  const HitColumns hits{x_.data(), y_.data(), z_.data(), reach_.data()};
  alignas(kLaneAlignment) std::array<Lanes, LaneSums::kCarryInterval> masses;
  for (std::size_t first = 0; first < selected_.size(); first += masses.size()) {
    const std::size_t size = std::min(masses.size(), selected_.size() - first);
    const std::uint32_t* const batch = selected_.data() + first;
    const auto massOfBatch = kernel_ == Kernel::Sparse ? sparseMass : linearMass;
    massOfBatch(hits, batch, size, group, block_, length_, masses.data());
    if (scores_.empty()) {
      sums_.add(label_.data(), batch, masses.data(), size);
    } else {
      sums_.add(scores_.data(), batch, masses.data(), size);
    }
    sums_.carry();
  }
  return sums_.finish();
}

}  // namespace csom::detail
