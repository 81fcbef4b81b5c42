// SPDX-License-Identifier: BSD-3-Clause
// A simulated world: solids with classes, and exact answers about them.
#pragma once

#include <csom/eval/MovingSolid.h>
#include <csom/eval/Solid.h>
#include <csom/io/LabelSet.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace csom {

/// The surface that a ray meets first.
struct SurfaceHit {
  double distance = 0;  ///< from the ray's origin [m]
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< outwards, unit length
  /// Index into World::solids(), or behind those into World::movingSolids().
  int solid = 0;
  ClassId class_id = kFreeClass;
  Color color{};
};

/// Immutable, hence safe to use from any number of threads. Where solids overlap, and where their
/// surfaces coincide, the one listed later counts; moving ones count as listed behind the others.
///
/// Moving solids are seen by rays alone: what is asked about points and boxes is the truth of what
/// stays.
class World {
 public:
  /// Throws std::invalid_argument if a solid's class is free or not in `labels`.
  World(LabelSet labels, std::vector<Solid> solids, std::vector<MovingSolid> moving = {});

  const LabelSet& labels() const { return labels_; }
  const std::vector<Solid>& solids() const { return solids_; }
  const std::vector<MovingSolid>& movingSolids() const { return moving_; }
  /// Smallest box around all solids that stay; empty for a world without any.
  Eigen::AlignedBox3d bounds() const;

  /// The nearest surface along a ray, at most `max_range` away, `time` seconds after the start of
  /// the simulation. `direction` has unit length.
  std::optional<SurfaceHit> castRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                    double max_range, double time = 0) const;

  /// The solid that holds a point; nothing in free space.
  std::optional<int> solidAt(const Eigen::Vector3d& point) const;
  /// Its class; kFreeClass in free space.
  ClassId classAt(const Eigen::Vector3d& point) const;

  /// Indices (ascending) of the solids that touch the inside of a box.
  std::vector<int> solidsTouching(const Eigen::AlignedBox3d& box) const;

 private:
  /// Node of a tree of bounding boxes over `order_`; children of an inner node are `left`, left+1.
  struct Node {
    Eigen::AlignedBox3d box;
    int first = 0;
    int count = 0;  ///< 0: inner node
    int left = 0;
  };
  void buildTree();
  void split(int node, int first, int count);
  template <class MayEnter, class Visit>
  void traverse(MayEnter&& may_enter, Visit&& visit) const;

  LabelSet labels_;
  std::vector<Solid> solids_;
  std::vector<MovingSolid> moving_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace csom
