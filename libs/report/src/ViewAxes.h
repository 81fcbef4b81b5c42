// SPDX-License-Identifier: BSD-3-Clause
// Which axes of the map a picture from above shows.
#pragma once

#include <csom/core/types.h>

#include <Eigen/Core>
#include <array>
#include <string>

namespace csom {

/// An axis of the map, forwards or backwards.
struct SignedAxis {
  int axis = 0;   ///< 0 x, 1 y, 2 z
  int sign = +1;  ///< +1 or −1

  /// Index of a voxel along the axis; floor(−c/r) of a voxel i is −i−1.
  std::int32_t along(const VoxelIndex& v) const {
    const std::int32_t i = std::array{v.x, v.y, v.z}[static_cast<std::size_t>(axis)];
    return sign > 0 ? i : -i - 1;
  }
  double along(const Eigen::Vector3d& point) const { return sign * point[axis]; }
  SignedAxis reversed() const { return {axis, -sign}; }
  /// "x", "-z".
  std::string name() const { return (sign > 0 ? "" : "-") + std::string(1, "xyz"[axis]); }
};

/// Three axes of the map, right-handed: where right, ahead and up are for one who stands in it.
struct ViewAxes {
  SignedAxis right;
  SignedAxis ahead;
  SignedAxis up;

  /// With the axis of the map that is nearest to `up`, and x to the right wherever that is
  /// possible.
  static ViewAxes standing(const Eigen::Vector3d& up) {
    Eigen::Index axis = 2;
    up.cwiseAbs().maxCoeff(&axis);
    const int sign = up[axis] < 0 ? -1 : +1;
    switch (axis) {
      case 0:
        return {{1, +1}, {2, sign}, {0, sign}};
      case 1:
        return {{0, +1}, {2, -sign}, {1, sign}};
      default:
        return {{0, +1}, {1, sign}, {2, sign}};
    }
  }
};

}  // namespace csom
