// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/Solid.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "eval/RandomSolids.h"

namespace csom {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;
using test::randomCube;
using test::randomDirection;
using test::randomSolid;
using test::randomVector;

constexpr double kPi = 3.14159265358979323846;

void expectEntry(const Solid& solid, const Vector3d& origin, const Vector3d& direction,
                 double distance, const Vector3d& normal) {
  const auto entry = solid.enter(origin, direction);
  ASSERT_TRUE(entry);
  EXPECT_NEAR(entry->distance, distance, 1e-12);
  EXPECT_LT((entry->normal - normal).norm(), 1e-12);
}

TEST(Solid, RayMeetsTheFacesOfABox) {
  const Solid box = Solid::box({1, 2, 3}, {2, 4, 6});
  expectEntry(box, {-5, 2, 3}, {1, 0, 0}, 5, {-1, 0, 0});
  expectEntry(box, {5, 2, 3}, {-1, 0, 0}, 3, {1, 0, 0});
  expectEntry(box, {1, 10, 3}, {0, -1, 0}, 6, {0, 1, 0});
  expectEntry(box, {1, 2, -4}, {0, 0, 1}, 4, {0, 0, -1});
  EXPECT_FALSE(box.enter({-5, 4.01, 3}, {1, 0, 0}));
  EXPECT_FALSE(box.enter({-5, 2, 3}, {-1, 0, 0})) << "behind the ray";
}

TEST(Solid, RayMeetsATurnedBox) {
  const double half_diagonal = std::sqrt(2.0);
  const Solid box = Solid::box({0, 0, 0}, {2, 2, 2}, kPi / 4);
  const double s = std::sqrt(0.5);
  expectEntry(box, {-3, 0.5, 0}, {1, 0, 0}, 3 - half_diagonal + 0.5, {-s, s, 0});
}

TEST(Solid, RayMeetsSideAndCapsOfACylinder) {
  const Solid cylinder = Solid::cylinder({0, 0, 1}, 0.5, 2);
  expectEntry(cylinder, {-3, 0, 1}, {1, 0, 0}, 2.5, {-1, 0, 0});
  expectEntry(cylinder, {0.3, 0.3, 5}, {0, 0, -1}, 3, {0, 0, 1});
  EXPECT_FALSE(cylinder.enter({0.4, 0.4, 5}, {0, 0, -1})) << "outside of the cap";
  EXPECT_FALSE(cylinder.enter({-3, 0, 2.01}, {1, 0, 0}));
}

TEST(Solid, RayMeetsASphere) {
  const Solid sphere = Solid::sphere({0, 0, 0}, 2);
  const double depth = std::sqrt(3.0);
  expectEntry(sphere, {-5, 1, 0}, {1, 0, 0}, 5 - depth, {-depth / 2, 0.5, 0});
  EXPECT_FALSE(sphere.enter({-5, 2.001, 0}, {1, 0, 0}));
}

TEST(Solid, RayFromInsideNeverEnters) {
  Random random(1, 0);
  for (int i = 0; i < 300; ++i) {
    const Solid solid = randomSolid(random, i);
    EXPECT_FALSE(solid.enter(solid.center(), randomDirection(random)));
  }
}

/// First point of the ray inside the solid, found by small steps and bisection.
double firstInside(const Solid& solid, const Vector3d& origin, const Vector3d& direction) {
  constexpr double kStep = 0.01;
  for (double t = 0; t < 25; t += kStep) {
    if (!solid.contains(origin + t * direction)) continue;
    double low = t - kStep;
    double high = t;
    for (int i = 0; i < 40; ++i) {
      const double middle = (low + high) / 2;
      (solid.contains(origin + middle * direction) ? high : low) = middle;
    }
    return high;
  }
  return std::numeric_limits<double>::infinity();
}

TEST(Solid, EntryIsTheFirstPointInside) {
  Random random(2, 0);
  int entered = 0;
  for (int i = 0; i < 600; ++i) {
    const Solid solid = randomSolid(random, i);
    const Vector3d origin = solid.center() + 8 * randomDirection(random);
    const Vector3d direction = (solid.center() + randomVector(random, 1) - origin).normalized();
    const auto entry = solid.enter(origin, direction);
    const double expected = firstInside(solid, origin, direction);
    if (std::isinf(expected)) {
      // Steps may jump over a thin corner, but over no more than that.
      if (entry) {
        EXPECT_FALSE(solid.contains(origin + (entry->distance + 0.02) * direction));
      }
      continue;
    }
    ++entered;
    ASSERT_TRUE(entry);
    EXPECT_NEAR(entry->distance, expected, 1e-9);
    EXPECT_NEAR(entry->normal.norm(), 1, 1e-12);
    EXPECT_LE(entry->normal.dot(direction), 1e-9) << "the normal points outwards";
  }
  EXPECT_GT(entered, 200);
}

TEST(Solid, TouchesAndCoversAgreeWithSampledPoints) {
  constexpr int kSamples = 12;
  Random random(3, 0);
  int touched = 0;
  int covered = 0;
  for (int i = 0; i < 1500; ++i) {
    const Solid solid = randomSolid(random, i);
    AlignedBox3d cube = randomCube(random);
    if (i % 2 == 0) cube.translate(solid.center() - cube.center());
    int inside = 0;
    for (int n = 0; n < kSamples * kSamples * kSamples; ++n) {
      const Vector3d cell(n % kSamples, n / kSamples % kSamples, n / (kSamples * kSamples));
      const Vector3d at = (cell + Vector3d::Constant(0.5)) / kSamples;
      inside += solid.contains(cube.min() + at.cwiseProduct(cube.sizes()));
    }
    const bool all = inside == kSamples * kSamples * kSamples;
    EXPECT_TRUE(inside == 0 || solid.touches(cube));
    EXPECT_TRUE(all || !solid.covers(cube));
    touched += solid.touches(cube);
    covered += solid.covers(cube);
  }
  EXPECT_GT(touched, 300);
  EXPECT_GT(covered, 100);
}

TEST(Solid, NearMissesDoNotTouch) {
  const AlignedBox3d cube(Vector3d(0, 0, 0), Vector3d(1, 1, 1));
  // The bounding boxes overlap in each of these, the solids do not.
  EXPECT_FALSE(Solid::box({1.8, 1.8, 0.5}, {2, 2, 1}, kPi / 4).touches(cube));
  EXPECT_TRUE(Solid::box({1.65, 1.65, 0.5}, {2, 2, 1}, kPi / 4).touches(cube));
  EXPECT_FALSE(Solid::cylinder({1.8, 1.8, 0.5}, 1.1, 1).touches(cube));
  EXPECT_TRUE(Solid::cylinder({1.8, 1.8, 0.5}, 1.2, 1).touches(cube));
  EXPECT_FALSE(Solid::sphere({1.6, 1.6, 1.6}, 1.0).touches(cube));
  EXPECT_TRUE(Solid::sphere({1.6, 1.6, 1.6}, 1.1).touches(cube));
}

TEST(Solid, SharedFacesDoNotTouch) {
  const AlignedBox3d cube(Vector3d(0, 0, 0), Vector3d(1, 1, 1));
  EXPECT_FALSE(Solid::box({1.5, 0.5, 0.5}, {1, 1, 1}).touches(cube));
  EXPECT_FALSE(Solid::box({0.5, 0.5, -0.5}, {9, 9, 1}).touches(cube));
  EXPECT_FALSE(Solid::cylinder({0.5, 0.5, 2}, 1, 2).touches(cube));
  EXPECT_FALSE(Solid::sphere({2, 0.5, 0.5}, 1).touches(cube));
}

TEST(Solid, RefusesSizesThatAreNotAboveZero) {
  EXPECT_THROW(Solid::box({0, 0, 0}, {1, 0, 1}), std::invalid_argument);
  EXPECT_THROW(Solid::cylinder({0, 0, 0}, -1, 1), std::invalid_argument);
  EXPECT_THROW(Solid::sphere({0, 0, 0}, std::nan("")), std::invalid_argument);
  EXPECT_THROW(Solid::sphere({0, std::nan(""), 0}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace csom
