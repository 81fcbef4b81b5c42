// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/GroundTruth.h>
#include <csom/eval/Scenario.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "eval/RandomSolids.h"

namespace csom {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

LabelSet labels() {
  return LabelSet::load(CSOM_SOURCE_DIR "/config/labels/simulator.yaml");
}

Solid withClass(Solid solid, ClassId id) {
  solid.class_id = id;
  return solid;
}

constexpr TruthVoxel kFree{TruthState::Free, kFreeClass};
constexpr TruthVoxel kInterior{TruthState::Interior, kFreeClass};
constexpr TruthVoxel occupied(ClassId id) {
  return {TruthState::Occupied, id};
}

TEST(GroundTruth, ShellOfABoxIsOccupiedAndItsInsideIsNot) {
  // Faces through the middle of voxels: x, y, z from 0.5 to 4.5 voxels.
  const World world(labels(), {withClass(Solid::box({2.5, 2.5, 2.5}, {4, 4, 4}), 3)});
  const GroundTruth truth(world, 1.0);
  for (int z = -1; z <= 5; ++z)
    for (int y = -1; y <= 5; ++y)
      for (int x = -1; x <= 5; ++x) {
        const int low = std::min({x, y, z});
        const int high = std::max({x, y, z});
        const TruthVoxel expected = low < 0 || high > 4     ? kFree
                                    : low == 0 || high == 4 ? occupied(3)
                                                            : kInterior;
        EXPECT_TRUE(truth.at({x, y, z}) == expected) << x << " " << y << " " << z;
      }
}

TEST(GroundTruth, AFaceOnTheBorderOfVoxelsLeavesTheVoxelBeyondFree) {
  const World world(labels(), {withClass(Solid::box({1.5, 0.5, 0.5}, {1, 1, 1}), 3)});
  const GroundTruth truth(world, 1.0);
  EXPECT_TRUE(truth.at({0, 0, 0}) == kFree);
  EXPECT_TRUE(truth.at({1, 0, 0}) == kInterior);
}

TEST(GroundTruth, TheSmallestReachIntoAVoxelOccupiesIt) {
  const World world(labels(), {withClass(Solid::sphere({0.5, 0.5, 1.499}, 0.5), 3)});
  const GroundTruth truth(world, 1.0);
  EXPECT_TRUE(truth.at({0, 0, 0}) == occupied(3)) << "reaches in by 1 mm";
}

TEST(GroundTruth, WhatTwoSolidsFillTogetherIsInterior) {
  const World world(labels(), {withClass(Solid::box({0, 0, -1}, {20, 20, 3}), 1),
                               withClass(Solid::box({0, 0, 3}, {8, 8, 5}), 3)});
  const GroundTruth truth(world, 1.0);  // they meet at z = 0.5
  EXPECT_TRUE(truth.at({0, 0, 0}) == kInterior) << "below the upper box";
  EXPECT_TRUE(truth.at({6, 0, 0}) == occupied(1)) << "beside it";
  EXPECT_TRUE(truth.at({6, 0, 1}) == kFree);
}

TEST(GroundTruth, MostExposedSurfaceDecidesTheClass) {
  // Ground up to z = 0.5; a post of a tenth of the voxel's width, and one that nearly fills it.
  const Solid ground = withClass(Solid::box({0, 0, -1}, {20, 20, 3}), 1);
  const Solid thin = withClass(Solid::box({0.5, 0.5, 0}, {0.05, 0.05, 2}), 2);
  const Solid wide = withClass(Solid::box({0.5, 0.5, 0}, {0.9, 0.9, 2}), 2);
  const World thin_world(labels(), {ground, thin});
  const World wide_world(labels(), {ground, wide});
  EXPECT_TRUE(GroundTruth(thin_world, 1.0).at({0, 0, 0}) == occupied(1));
  EXPECT_TRUE(GroundTruth(wide_world, 1.0).at({0, 0, 0}) == occupied(2));
}

TEST(GroundTruth, HitsOfNoiseFreeRaysLieInOccupiedVoxelsOnly) {
  const Scenario scenario = loadScenario(CSOM_SOURCE_DIR "/config/worlds/room.yaml");
  const GroundTruth truth(scenario.world, 0.1);
  Random random(3, 0);
  int same_class = 0;
  constexpr int kRays = 20000;
  for (int i = 0; i < kRays; ++i) {
    const PlanarPose robot = scenario.path.at(random.uniform(0, scenario.path.duration()));
    const Vector3d origin(robot.x, robot.y, 0.9);
    const Vector3d direction = test::randomDirection(random);
    const auto hit = scenario.world.castRay(origin, direction, 20);
    ASSERT_TRUE(hit) << "the room is closed";
    const TruthVoxel end = truth.at(truth.grid().voxelAt(hit->point + 1e-9 * direction));
    ASSERT_EQ(end.state, TruthState::Occupied) << hit->point.transpose();
    same_class += end.class_id == hit->class_id;
    const Vector3d on_the_way = origin + random.uniform() * hit->distance * direction;
    EXPECT_NE(truth.at(truth.grid().voxelAt(on_the_way)).state, TruthState::Interior);
  }
  EXPECT_GT(same_class, 0.97 * kRays) << "the rest are voxels that two classes share";
}

TEST(GroundTruth, MapHoldsTheTruthOfEveryVoxelOfTheBox) {
  Random random(4, 0);
  std::vector<Solid> solids;
  for (int i = 0; i < 25; ++i)
    solids.push_back(withClass(test::randomSolid(random, i), static_cast<ClassId>(1 + i % 9)));
  const World world(labels(), solids);
  const GroundTruth truth(world, 0.3);
  const VoxelBox box{{-17, -5, -9}, {12, 16, 3}};
  const SemanticMap map = truth.toMap(box);
  EXPECT_EQ(map.options().resolution, 0.3);
  EXPECT_EQ(map.options().number_of_classes, labels().numberOfClasses());
  std::size_t known = 0;
  for (int z = -20; z <= 20; ++z)
    for (int y = -20; y <= 20; ++y)
      for (int x = -20; x <= 20; ++x) {
        const DirichletVoxel voxel = map.voxel({x, y, z});
        const bool inside = x >= box.min.x && x <= box.max.x && y >= box.min.y && y <= box.max.y &&
                            z >= box.min.z && z <= box.max.z;
        const TruthVoxel expected = truth.at({x, y, z});
        if (!inside || expected.state == TruthState::Interior) {
          EXPECT_FALSE(voxel.known());
          continue;
        }
        ++known;
        EXPECT_EQ(voxel.size(), 1);
        EXPECT_EQ(voxel.mostLikelyClass(), expected.class_id);
        EXPECT_DOUBLE_EQ(voxel.evidence(), 1.0);
      }
  EXPECT_EQ(map.knownVoxelCount(), known);
}

TEST(GroundTruth, RegionHoldsTheVoxelsWithTheirCentreInside) {
  const World world(labels(), {});
  const GroundTruth truth(world, 0.5);
  const VoxelBox box = truth.voxelsIn({Vector3d(0, -0.3, 1.25), Vector3d(1, 0.24, 1.75)});
  EXPECT_EQ(box.min, (VoxelIndex{0, -1, 2}));
  EXPECT_EQ(box.max, (VoxelIndex{1, -1, 3}));
}

TEST(GroundTruth, RefusesRegionsWithoutVoxelsOrWithTooMany) {
  const World world(labels(), {});
  const GroundTruth truth(world, 0.5);
  EXPECT_THROW(truth.voxelsIn({Vector3d(0, 0, 0), Vector3d(1, 1, 0.2)}), std::invalid_argument);
  EXPECT_THROW(truth.voxelsIn({Vector3d(0, 0, 0), Vector3d(1, 1, 1e9)}), std::invalid_argument);
  EXPECT_THROW(truth.voxelsIn({Vector3d(0, 0, 0), Vector3d(1e3, 1e3, 1e3)}), std::invalid_argument);
  EXPECT_THROW(GroundTruth(world, 0), std::invalid_argument);
}

}  // namespace
}  // namespace csom
