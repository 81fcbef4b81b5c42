// SPDX-License-Identifier: BSD-3-Clause
// Finding the solids of a world through a tree of their bounding boxes.
#include <csom/eval/World.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

namespace csom {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr int kLeafSize = 2;
/// Surfaces nearer to each other than this count as one.
constexpr double kSameSurface = 1e-9;

/// Distance at which a ray enters a box, or infinity.
double distanceToBox(const AlignedBox3d& box, const Vector3d& origin, const Vector3d& direction,
                     const Vector3d& inverse) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  double begin = 0;
  double end = kNever;
  for (int axis = 0; axis < 3; ++axis) {
    const double to_min = box.min()[axis] - origin[axis];
    const double to_max = box.max()[axis] - origin[axis];
    if (direction[axis] == 0) {
      if (to_min > 0 || to_max < 0) return kNever;
      continue;
    }
    const double a = to_min * inverse[axis];
    const double b = to_max * inverse[axis];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return begin <= end + kSameSurface ? begin : kNever;
}

void checkClass(ClassId id, std::size_t solid, const LabelSet& labels) {
  if (id == kFreeClass || id >= labels.numberOfClasses())
    throw std::invalid_argument("solid " + std::to_string(solid) + " has class " +
                                std::to_string(id) + ", which label set '" + labels.name() +
                                "' does not have or calls free");
}

}  // namespace

World::World(LabelSet labels, std::vector<Solid> solids, std::vector<MovingSolid> moving)
    : labels_(std::move(labels)), solids_(std::move(solids)), moving_(std::move(moving)) {
  for (std::size_t i = 0; i < solids_.size(); ++i) checkClass(solids_[i].class_id, i, labels_);
  for (std::size_t i = 0; i < moving_.size(); ++i)
    checkClass(moving_[i].solid().class_id, solids_.size() + i, labels_);
  buildTree();
}

AlignedBox3d World::bounds() const {
  return nodes_.empty() ? AlignedBox3d() : nodes_.front().box;
}

void World::buildTree() {
  if (solids_.empty()) return;
  order_.resize(solids_.size());
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.emplace_back();
  split(0, 0, static_cast<int>(order_.size()));
}

void World::split(int node, int first, int count) {
  AlignedBox3d box;
  AlignedBox3d centers;
  for (int i = first; i < first + count; ++i) {
    const Solid& solid = solids_[static_cast<std::size_t>(order_[static_cast<std::size_t>(i)])];
    box.extend(solid.bounds());
    centers.extend(solid.center());
  }
  nodes_[static_cast<std::size_t>(node)].box = box;
  if (count <= kLeafSize) {
    nodes_[static_cast<std::size_t>(node)].first = first;
    nodes_[static_cast<std::size_t>(node)].count = count;
    return;
  }
  Eigen::Index axis = 0;
  centers.sizes().maxCoeff(&axis);
  const int half = count / 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](int a, int b) {
    return solids_[static_cast<std::size_t>(a)].center()[axis] <
           solids_[static_cast<std::size_t>(b)].center()[axis];
  });
  const int left = static_cast<int>(nodes_.size());
  nodes_[static_cast<std::size_t>(node)].left = left;
  nodes_.resize(nodes_.size() + 2);
  split(left, first, half);
  split(left + 1, first + half, count - half);
}

template <class MayEnter, class Visit>
void World::traverse(MayEnter&& may_enter, Visit&& visit) const {
  if (nodes_.empty()) return;
  std::array<int, 64> stack{};  // median splits: as deep as log2 of the number of solids
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[static_cast<std::size_t>(stack[--size])];
    if (!may_enter(node.box)) continue;
    for (int i = 0; i < node.count; ++i) visit(order_[static_cast<std::size_t>(node.first + i)]);
    if (node.count == 0) {
      stack[size++] = node.left;
      stack[size++] = node.left + 1;
    }
  }
}

std::optional<SurfaceHit> World::castRay(const Vector3d& origin, const Vector3d& direction,
                                         double max_range, double time) const {
  const Vector3d inverse = direction.cwiseInverse();
  double best = max_range;
  std::optional<Solid::Entry> nearest;
  int hit_solid = -1;
  const auto mayEnter = [&](const AlignedBox3d& box) {
    return distanceToBox(box, origin, direction, inverse) <= best + kSameSurface;
  };
  const auto consider = [&](const std::optional<Solid::Entry>& entry, int index) {
    if (!entry || entry->distance > best + kSameSurface) return;
    const bool same = nearest && entry->distance > best - kSameSurface;
    if (same && index < hit_solid) return;
    if (!nearest && entry->distance > max_range) return;
    nearest = entry;
    hit_solid = index;
    best = std::min(best, entry->distance);
  };
  traverse(mayEnter, [&](int index) {
    consider(solids_[static_cast<std::size_t>(index)].enter(origin, direction), index);
  });
  const std::size_t standing = solids_.size();
  for (std::size_t i = 0; i < moving_.size(); ++i)
    if (mayEnter(moving_[i].bounds()))
      consider(moving_[i].enter(origin, direction, time), static_cast<int>(standing + i));
  if (!nearest) return std::nullopt;
  const auto hit = static_cast<std::size_t>(hit_solid);
  const Solid& solid = hit < standing ? solids_[hit] : moving_[hit - standing].solid();
  return SurfaceHit{nearest->distance, origin + nearest->distance * direction,
                    nearest->normal,   hit_solid,
                    solid.class_id,    solid.color};
}

std::optional<int> World::solidAt(const Vector3d& point) const {
  int last = -1;
  traverse([&](const AlignedBox3d& box) { return box.contains(point); },
           [&](int index) {
             if (index > last && solids_[static_cast<std::size_t>(index)].contains(point))
               last = index;
           });
  return last < 0 ? std::nullopt : std::optional<int>(last);
}

ClassId World::classAt(const Vector3d& point) const {
  const std::optional<int> solid = solidAt(point);
  return solid ? solids_[static_cast<std::size_t>(*solid)].class_id : kFreeClass;
}

std::vector<int> World::solidsTouching(const AlignedBox3d& box) const {
  std::vector<int> found;
  traverse([&](const AlignedBox3d& node) { return node.intersects(box); },
           [&](int index) {
             if (solids_[static_cast<std::size_t>(index)].touches(box)) found.push_back(index);
           });
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace csom
