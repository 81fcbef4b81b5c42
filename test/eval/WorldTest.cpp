// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/World.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

constexpr ClassId kClasses = 5;

LabelSet labels() {
  return LabelSet::fromYaml(
      "name: test\nclasses:\n"
      "  - {id: 0, name: free, color: [255, 255, 255]}\n"
      "  - {id: 1, name: a, color: [1, 0, 0]}\n"
      "  - {id: 2, name: b, color: [2, 0, 0]}\n"
      "  - {id: 3, name: c, color: [3, 0, 0]}\n"
      "  - {id: 4, name: d, color: [4, 0, 0]}\n",
      "test");
}

World randomWorld(Random& random, int solids) {
  std::vector<Solid> list;
  for (int i = 0; i < solids; ++i) {
    Solid solid = randomSolid(random, i);
    solid.class_id = static_cast<ClassId>(1 + i % (kClasses - 1));
    list.push_back(solid);
  }
  return World(labels(), list);
}

Solid person(const Vector3d& center) {
  Solid solid = Solid::cylinder(center, 0.3, 1.8);
  solid.class_id = 2;
  return solid;
}

TEST(World, MovingSolidsAreSeenWhereTheyAre) {
  Solid wall = Solid::box({10, 0, 0}, {1, 20, 4});
  wall.class_id = 1;
  // Goes, stops for two seconds, goes on.
  const MovingSolid walker(person({5, 0, 0}),
                           {{1, {0, -4}}, {3, {0, 0}}, {5, {0, 0}}, {6, {0, 3}}});
  const World world(labels(), {wall}, {walker});
  const auto seenAt = [&](double time) { return world.castRay({0, 0, 0}, {1, 0, 0}, 50, time); };
  for (const double time : {0.0, 1.0, 2.8, 5.11, 6.0, 100.0}) {
    ASSERT_TRUE(seenAt(time));
    EXPECT_EQ(seenAt(time)->class_id, 1) << time;
    EXPECT_EQ(seenAt(time)->solid, 0);
  }
  for (const double time : {2.9, 3.0, 4.0, 5.0, 5.09}) {
    ASSERT_TRUE(seenAt(time));
    EXPECT_EQ(seenAt(time)->class_id, 2) << time;
    EXPECT_EQ(seenAt(time)->solid, 1);
  }
  EXPECT_NEAR(seenAt(4)->distance, 4.7, 1e-12);
  EXPECT_NEAR(seenAt(2.9)->distance, 5 - std::sqrt(0.09 - 0.04), 1e-9) << "0.2 m beside its middle";
  EXPECT_EQ(walker.offsetAt(2), Vector3d(0, -2, 0));
  EXPECT_EQ(walker.offsetAt(5.5), Vector3d(0, 1.5, 0));
  // The truth of places is that of what stays.
  EXPECT_EQ(world.classAt({5, 0, 0}), kFreeClass);
  EXPECT_TRUE(world.solidsTouching(AlignedBox3d(Vector3d(4, -1, -1), Vector3d(6, 1, 1))).empty());
  EXPECT_EQ(world.bounds().min().x(), 9.5);
}

TEST(World, MovingSolidsThatCannotBeAreRefused) {
  EXPECT_THROW(MovingSolid(person({0, 0, 0}), {{1, {0, 0}}}), std::invalid_argument);
  EXPECT_THROW(MovingSolid(person({0, 0, 0}), {{1, {0, 0}}, {1, {0, 1}}}), std::invalid_argument);
  EXPECT_THROW(MovingSolid(person({0, 0, 0}), {{1, {0, 0}}, {NAN, {0, 1}}}), std::invalid_argument);
  EXPECT_THROW(MovingSolid(person({0, 0, 0}), {{1, {0, 0}}, {2, {0, INFINITY}}}),
               std::invalid_argument);
  const MovingSolid without_class(Solid::sphere({0, 0, 0}, 1), {{1, {0, 0}}, {2, {0, 1}}});
  EXPECT_THROW(World(labels(), {}, {without_class}), std::invalid_argument);
}

TEST(World, NearestHitIsThatOfAllSolidsTriedOneByOne) {
  Random random(1, 0);
  int hits = 0;
  for (const int size : {1, 2, 3, 7, 40, 133}) {
    const World world = randomWorld(random, size);
    for (int i = 0; i < 500; ++i) {
      const Vector3d origin = randomVector(random, 8);
      Vector3d direction = randomDirection(random);
      if (i % 5 == 0) direction = Vector3d::Unit(i % 3) * (i % 2 == 0 ? 1.0 : -1.0);
      const double max_range = random.uniform(1, 20);
      double nearest = max_range;
      int solid = -1;
      for (int k = 0; k < size; ++k) {
        const auto entry = world.solids()[static_cast<std::size_t>(k)].enter(origin, direction);
        if (!entry || entry->distance > nearest) continue;
        nearest = entry->distance;
        solid = k;
      }
      const auto hit = world.castRay(origin, direction, max_range);
      ASSERT_EQ(hit.has_value(), solid >= 0);
      if (!hit) continue;
      ++hits;
      EXPECT_EQ(hit->solid, solid);
      EXPECT_DOUBLE_EQ(hit->distance, nearest);
      EXPECT_EQ(hit->class_id, world.solids()[static_cast<std::size_t>(solid)].class_id);
      EXPECT_LT((hit->point - (origin + nearest * direction)).norm(), 1e-12);
    }
  }
  EXPECT_GT(hits, 200);
}

TEST(World, PointAndBoxQueriesAreThoseOfAllSolids) {
  Random random(2, 0);
  const World world = randomWorld(random, 60);
  int found = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vector3d point = randomVector(random, 5);
    int last = -1;
    for (int k = 0; k < 60; ++k) {
      if (world.solids()[static_cast<std::size_t>(k)].contains(point)) last = k;
    }
    EXPECT_EQ(world.solidAt(point).value_or(-1), last);
    EXPECT_EQ(world.classAt(point), last < 0 ? kFreeClass : static_cast<ClassId>(1 + last % 4));
    found += last >= 0;

    const AlignedBox3d cube = randomCube(random);
    std::vector<int> touching;
    for (int k = 0; k < 60; ++k) {
      if (world.solids()[static_cast<std::size_t>(k)].touches(cube)) touching.push_back(k);
    }
    EXPECT_EQ(world.solidsTouching(cube), touching);
  }
  EXPECT_GT(found, 100);
}

TEST(World, OfCoincidingSurfacesTheLaterListedCounts) {
  Solid road = Solid::box({0, 0, -0.5}, {10, 10, 1});
  Solid stripe = Solid::box({0, 0, -0.1}, {1, 1, 0.2});
  road.class_id = 1;
  stripe.class_id = 2;
  const Vector3d down(0, 0, -1);
  EXPECT_EQ(World(labels(), {road, stripe}).castRay({0.2, 0.1, 3}, down, 9)->class_id, 2);
  EXPECT_EQ(World(labels(), {stripe, road}).castRay({0.2, 0.1, 3}, down, 9)->class_id, 1);
  EXPECT_EQ(World(labels(), {road, stripe}).classAt({0.2, 0.1, -0.1}), 2);
  EXPECT_EQ(World(labels(), {stripe, road}).classAt({0.2, 0.1, -0.1}), 1);
}

TEST(World, RayWithinTheFaceOfABoundingBoxStillHits) {
  Solid box = Solid::box({0, 0, 0}, {2, 2, 2});
  box.class_id = 1;
  const World world(labels(), {box, box, box, box});
  const auto hit = world.castRay({-5, 1, 1}, {1, 0, 0}, 100);
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit->distance, 4);
}

TEST(World, WithoutSolidsIsFree) {
  const World world(labels(), {});
  EXPECT_FALSE(world.castRay({0, 0, 0}, {1, 0, 0}, 100));
  EXPECT_EQ(world.classAt({0, 0, 0}), kFreeClass);
  EXPECT_TRUE(world.bounds().isEmpty());
}

TEST(World, RefusesClassesThatTheLabelSetDoesNotHave) {
  Solid box = Solid::box({0, 0, 0}, {1, 1, 1});
  EXPECT_THROW(World(labels(), {box}), std::invalid_argument) << "free";
  box.class_id = kClasses;
  EXPECT_THROW(World(labels(), {box}), std::invalid_argument);
}

}  // namespace
}  // namespace csom
