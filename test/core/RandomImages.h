// SPDX-License-Identifier: BSD-3-Clause
// Seeded random scans with an image: a spinning or a staring sensor in a room with boxes.
#pragma once

#include <csom/core/types.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/RandomScans.h"

namespace csom::test {

class RandomImage : public RandomCase {
 public:
  using RandomCase::RandomCase;

  Options imageOptions() {
    Options o;
    o.number_of_classes = integer(3, 8);
    o.resolution = oneOf<double>({0.1, 0.2, 0.25, 0.3, 3});
    o.free_space.mode = oneOf<FreeSpace>(
        {FreeSpace::None, FreeSpace::Projective, FreeSpace::Projective, FreeSpace::Projective});
    return o;
  }

  /// A room of a few hundred voxels around, seen from inside.
  Scan image(const Options& o, int max_rows = 8, int max_columns = 60) {
    const double size = o.resolution * real(4, 14);
    Scan s;
    s.origin = {real(-3, 3), real(-3, 3), real(-2, 2)};
    if (integer(0, 4) == 0)
      s.origin += Eigen::Vector3d(real(-1e5, 1e5), real(-1e5, 1e5), real(-1e3, 1e3));
    makeRoom(size, o.number_of_classes);
    const bool spins = integer(0, 2) > 0;
    const int rows = integer(3, max_rows);
    const int columns = integer(30, max_columns);
    const double height = real(0.05, 0.12) * rows;
    const double width = spins ? 2 * M_PI : real(0.4, 1.4);
    const int fine = integer(1, 7);
    const Eigen::Quaterniond turn =
        Eigen::AngleAxisd(real(-M_PI, M_PI), Eigen::Vector3d::UnitZ()) *
        Eigen::AngleAxisd(integer(0, 2) == 0 ? real(-0.6, 0.6) : 0, Eigen::Vector3d::UnitX());
    s.image.column_step = fine;
    s.image.columns_of_turn = spins ? columns * fine : 0;
    const bool soft = integer(0, 4) == 0;
    const double noise = integer(0, 1) == 0 ? 0 : 0.02;
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        if (integer(0, 15) == 0) continue;  // lost
        int at = column * fine + (fine > 2 ? integer(-1, 1) : 0);
        if (spins) at = (at + columns * fine) % (columns * fine);
        const double azimuth = width * at / (columns * fine);
        const double elevation = height * (rows > 1 ? double(row) / (rows - 1) - 0.6 : 0);
        const Eigen::Vector3d direction =
            turn * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                                   std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        const auto [range, label] = castRay(direction);
        s.points.push_back((direction * (range + real(-noise, noise))).cast<float>());
        s.image.pixels.push_back(
            {integer(0, 30) == 0 ? RangeImage::kNoRow : static_cast<std::uint16_t>(row), at});
        if (soft) {
          addScores(s, o.number_of_classes);
        } else {
          s.labels.push_back(integer(0, 40) == 0 ? ClassId{0} : label);
        }
      }
    return s;
  }

 private:
  struct Solid {
    Eigen::AlignedBox3d box;
    ClassId label;
  };

  void makeRoom(double size, int classes) {
    floor_ = -size * real(0.15, 0.5);
    walls_ = {Eigen::Vector3d(-size * real(0.3, 1), -size * real(0.3, 1), floor_),
              Eigen::Vector3d(size * real(0.3, 1), size * real(0.3, 1), size * real(0.2, 0.8))};
    wall_label_ = static_cast<ClassId>(integer(1, classes - 1));
    floor_label_ = static_cast<ClassId>(integer(1, classes - 1));
    solids_.clear();
    for (int i = integer(0, 4); i > 0; --i) {
      const Eigen::Vector3d low(real(-size, size), real(-size, size), floor_);
      solids_.push_back(
          {{low, low + Eigen::Vector3d(real(0.05, 0.3), real(0.05, 0.3), real(0.1, 0.6)) * size},
           static_cast<ClassId>(integer(1, classes - 1))});
    }
  }
  /// Range and label of what a ray from the sensor meets first.
  std::pair<double, ClassId> castRay(const Eigen::Vector3d& direction) const {
    double range = 1e9;
    ClassId label = wall_label_;
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] == 0) continue;
      const double plane = direction[axis] > 0 ? walls_.max()[axis] : walls_.min()[axis];
      const double at = plane / direction[axis];
      if (at >= range) continue;
      range = at;
      label = axis == 2 && direction[axis] < 0 ? floor_label_ : wall_label_;
    }
    for (const Solid& solid : solids_) {
      double enter = 0;
      double leave = 1e9;
      for (int axis = 0; axis < 3; ++axis) {
        const double a = solid.box.min()[axis] / direction[axis];
        const double b = solid.box.max()[axis] / direction[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
      }
      if (enter > 0 && enter < leave && enter < range) range = enter, label = solid.label;
    }
    return {range, label};
  }

  double floor_ = 0;
  Eigen::AlignedBox3d walls_;
  ClassId wall_label_ = 1;
  ClassId floor_label_ = 1;
  std::vector<Solid> solids_;
};

}  // namespace csom::test
