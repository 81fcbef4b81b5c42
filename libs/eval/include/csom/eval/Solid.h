// SPDX-License-Identifier: BSD-3-Clause
// What a simulated world is made of: convex solids, upright, with a class and a colour.
#pragma once

#include <csom/core/types.h>
#include <csom/io/LabelSet.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

namespace csom {

/// A box turned about the vertical, an upright cylinder or a sphere. Metres and radians, world
/// frame, z up. Closed sets: the surface belongs to the solid.
class Solid {
 public:
  enum class Shape { Box, Cylinder, Sphere };

  /// Where a ray enters a solid; the normal points outwards.
  struct Entry {
    double distance = 0;  ///< along the ray, in units of its direction's length
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  };

  /// Sizes are full edge lengths and must be positive.
  static Solid box(const Eigen::Vector3d& center, const Eigen::Vector3d& size, double yaw = 0);
  static Solid cylinder(const Eigen::Vector3d& center, double radius, double height);
  static Solid sphere(const Eigen::Vector3d& center, double radius);

  Shape shape() const { return shape_; }
  const Eigen::Vector3d& center() const { return center_; }
  Eigen::AlignedBox3d bounds() const;

  bool contains(const Eigen::Vector3d& point) const;
  /// True if the solid and the inside of `cube` have a point in common; exact.
  bool touches(const Eigen::AlignedBox3d& cube) const;
  /// True if all of `cube` lies in the solid; exact, since solids are convex.
  bool covers(const Eigen::AlignedBox3d& cube) const;
  /// Where a ray enters the solid. A ray that starts inside never does.
  std::optional<Entry> enter(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

  ClassId class_id = kFreeClass;
  Color color{128, 128, 128};

 private:
  Solid(Shape shape, const Eigen::Vector3d& center, const Eigen::Vector3d& half_size, double yaw);

  /// World → the solid's own axes.
  Eigen::Vector3d turned(const Eigen::Vector3d& v) const;
  Eigen::Vector3d turnedBack(const Eigen::Vector3d& v) const;

  Shape shape_;
  Eigen::Vector3d center_;
  Eigen::Vector3d half_size_;  ///< a cylinder's and a sphere's x and y are the radius
  double cos_yaw_;
  double sin_yaw_;
};

}  // namespace csom
