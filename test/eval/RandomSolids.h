// SPDX-License-Identifier: BSD-3-Clause
// Random solids, boxes and directions for property tests.
#pragma once

#include <csom/eval/Random.h>
#include <csom/eval/Solid.h>

#include <cmath>

namespace csom::test {

inline Eigen::Vector3d randomVector(Random& random, double reach) {
  const double x = random.uniform(-reach, reach);
  const double y = random.uniform(-reach, reach);
  const double z = random.uniform(-reach, reach);
  return {x, y, z};
}

inline Eigen::Vector3d randomDirection(Random& random) {
  Eigen::Vector3d v = randomVector(random, 1);
  while (v.norm() < 0.1 || v.norm() > 1) v = randomVector(random, 1);
  return v.normalized();
}

/// Within 5 m of the origin, 0.2 to 3 m large; shapes take turns.
inline Solid randomSolid(Random& random, int turn) {
  const Eigen::Vector3d center = randomVector(random, 4);
  const double a = random.uniform(0.2, 3);
  const double b = random.uniform(0.2, 3);
  const double c = random.uniform(0.2, 3);
  if (turn % 3 == 0) return Solid::box(center, {a, b, c}, random.uniform(-3.2, 3.2));
  if (turn % 3 == 1) return Solid::cylinder(center, a / 2, b);
  return Solid::sphere(center, a / 2);
}

inline Eigen::AlignedBox3d randomCube(Random& random) {
  const Eigen::Vector3d corner = randomVector(random, 5);
  return {corner, corner + Eigen::Vector3d::Constant(random.uniform(0.05, 1.5))};
}

}  // namespace csom::test
