// SPDX-License-Identifier: BSD-3-Clause
#include "surface/SurfaceClasses.h"

#include <algorithm>
#include <array>

#include "inference/KernelMassLoops.h"

namespace csom::detail {

namespace {

CSOM_EVERY_PROCESSOR
std::size_t selectNear(const HitColumns& hits, std::size_t size, const BlockPlace& block,
                       float length, std::uint32_t* selected) {
  const std::array<PointRange, 1> all{{{0, static_cast<std::uint32_t>(size)}}};
  return selectPoints(
      hits, all, block,
      [ length, reach = hits.reach.data() ](std::uint32_t first) __attribute__((always_inline)) {
        const Lanes own = load(reach + first);
        return (own > length ? own : Lanes{} + length) * kUnits;
      },
      selected);
}

CSOM_EVERY_PROCESSOR
void addMass(Kernel kernel, const HitColumns& hits, const std::vector<std::uint32_t>& selected,
             const std::vector<float>& scores, const LaneGroup& group, const BlockPlace& block,
             float length, LaneSums& sums) {
  addMassOfPoints(
      kernel,
      [ length, reach = hits.reach.data() ](std::uint32_t p)
          __attribute__((always_inline)) { return 1.0F / std::max(length, reach[p]) / kUnits; },
      hits, selected, scores, group, block, sums);
}

CSOM_EVERY_PROCESSOR
void divideSums(const LaneSums& sums, const std::array<float, kLanes>& occupied, double scale,
                CountLanes* counts) {
  MassLanes total{};
  for (const ClassId k : sums.classes())
    if (k != kFreeClass) total += sums.mass(k);
  const MassLanes mass = __builtin_convertvector(load(occupied.data()), MassLanes) * scale;
  const MassLanes share = total > 0.0 ? mass / total : MassLanes{};
  for (const ClassId k : sums.classes())
    if (k != kFreeClass) toCounts(sums.mass(k) * share, *counts++);
}

}  // namespace

void SurfaceClasses::clear() {
  size_ = 0;
  hits_.label.clear();
  scores_.clear();
}

void SurfaceClasses::add(const PointColumns& points, const std::vector<LocalSurface>& surfaces,
                         const std::vector<float>& scores, std::uint32_t begin, std::uint32_t end) {
  const std::size_t most = size_ + (end - begin) + kLanes;
  if (hits_.x.size() < most) {
    for (std::vector<FixedPoint>* axis : {&hits_.x, &hits_.y, &hits_.z}) axis->resize(2 * most);
    hits_.reach.resize(2 * most);
  }
  const std::size_t classes = scores.size() / points.label.size();
  for (std::uint32_t p = begin; p < end; ++p) {
    if (surfaces[p].shape == LocalSurface::Shape::Free) continue;
    hits_.x[size_] = points.x[p];
    hits_.y[size_] = points.y[p];
    hits_.z[size_] = points.z[p];
    hits_.reach[size_] = surfaces[p].reach();
    hits_.label.push_back(points.label[p]);
    const auto row = scores.begin() + static_cast<std::ptrdiff_t>(p * classes);
    scores_.insert(scores_.end(), row, row + static_cast<std::ptrdiff_t>(classes));
    ++size_;
  }
}

void SurfaceClasses::select(const BlockPlace& block, float length) {
  block_ = block;
  length_ = length;
  selected_.resize(size_);
  selected_.resize(selectNear(hits_, size_, block, length, selected_.data()));
}

std::optional<ClassId> SurfaceClasses::onlyClass() const {
  if (!scores_.empty() || selected_.empty()) return std::nullopt;
  const ClassId first = hits_.label[selected_.front()];
  const bool same = std::all_of(selected_.begin(), selected_.end(),
                                [&](std::uint32_t p) { return hits_.label[p] == first; });
  return same ? std::optional<ClassId>(first) : std::nullopt;
}

void SurfaceClasses::divide(const LaneGroup& group, const std::array<float, kLanes>& occupied,
                            double scale, std::vector<ClassId>& classes,
                            std::vector<CountLanes>& counts) {
  sums_.reset();
  addMass(kernel_, hits_, selected_, scores_, group, block_, length_, sums_);
  sums_.finish();
  for (const ClassId k : sums_.classes())
    if (k != kFreeClass) classes.push_back(k);  // samples of free space among soft scores
  const std::size_t before = counts.size();
  counts.resize(classes.size());
  divideSums(sums_, occupied, scale, counts.data() + before);
}

}  // namespace csom::detail
