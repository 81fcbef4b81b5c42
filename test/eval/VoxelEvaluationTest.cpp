// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/VoxelEvaluation.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "eval/FakeMapper.h"
#include "eval/LabelledVoxels.h"

namespace csom {
namespace {

using test::FakeMapper;
using test::mapOf;

TEST(VoxelTruth, OfAPointCloudIsPaddedWithFreeVoxels) {
  VoxelTruth truth(mapOf({{{0, 0, 0}, 1}, {{1, 0, 0}, 2}}), 0.5);
  EXPECT_FALSE(truth.knowsFree());
  EXPECT_EQ(truth.at({1, 0, 0}), 2);
  EXPECT_EQ(truth.at({2, 1, -1}), kFreeClass);
  EXPECT_FALSE(truth.at({3, 0, 0}));
  std::size_t voxels = 0;
  truth.forEach([&](const Eigen::Vector3d&, ClassId) { ++voxels; });
  EXPECT_EQ(voxels, 4U * 3U * 3U);

  truth.leaveOut({1, 0, 0});
  truth.leaveOut({40, 0, 0});  // beyond: nothing happens
  EXPECT_FALSE(truth.at({1, 0, 0}));
  voxels = 0;
  truth.forEach([&](const Eigen::Vector3d&, ClassId) { ++voxels; });
  EXPECT_EQ(voxels, 35U);
}

TEST(VoxelTruth, OfASimulatedWorldLeavesOutWhatItDoesNotKnow) {
  const VoxelTruth truth(mapOf({{{0, 0, 0}, 0}, {{3, 0, 0}, 1}}));
  EXPECT_TRUE(truth.knowsFree());
  EXPECT_EQ(truth.at({0, 0, 0}), kFreeClass);
  EXPECT_EQ(truth.at({3, 0, 0}), 1);
  EXPECT_FALSE(truth.at({1, 0, 0}));
  EXPECT_FALSE(truth.at({-1, 0, 0}));
}

TEST(VoxelTruth, EachCenterIsThatOfItsVoxel) {
  const VoxelTruth truth(mapOf({{{-3, 2, 1}, 3}, {{0, 0, 0}, 0}}));
  std::vector<Eigen::Vector3d> occupied;
  truth.forEach([&](const Eigen::Vector3d& center, ClassId k) {
    if (k == 3) occupied.push_back(center);
  });
  ASSERT_EQ(occupied.size(), 1U);
  EXPECT_EQ(occupied[0], Eigen::Vector3d(-1.25, 1.25, 0.75));
}

TEST(VoxelTruth, KeepsOnlyWhatAnotherMapKnows) {
  VoxelTruth truth(mapOf({{{0, 0, 0}, 0}, {{1, 0, 0}, 1}, {{2, 0, 0}, 2}}));
  truth.keepOnly(mapOf({{{1, 0, 0}, 3}, {{2, 0, 0}, 0}, {{7, 0, 0}, 1}}));
  EXPECT_FALSE(truth.at({0, 0, 0}));
  EXPECT_EQ(truth.at({1, 0, 0}), 1);
  EXPECT_EQ(truth.at({2, 0, 0}), 2);
}

TEST(VoxelTruth, OfNothingThrows) {
  EXPECT_THROW(VoxelTruth(mapOf({})), std::invalid_argument);
}

TEST(VoxelEvaluation, ScoresClassesAndOccupancy) {
  const VoxelTruth truth(
      mapOf({{{0, 0, 0}, 0}, {{1, 0, 0}, 1}, {{2, 0, 0}, 2}, {{3, 0, 0}, 0}, {{4, 0, 0}, 1}}));
  FakeMapper map(0.5, true);
  map.set({0, 0, 0}, {0.8, 0.1, 0.1, 0});  // right
  map.set({1, 0, 0}, {0.2, 0.7, 0.1, 0});  // right
  map.set({2, 0, 0}, {0.1, 0.6, 0.3, 0});  // occupied, wrong class
  map.set({9, 0, 0}, {0, 0, 0, 1});        // nobody asks
  const VoxelEvaluation evaluation = evaluateVoxels(map, truth);
  EXPECT_EQ(evaluation.known, 3U);
  EXPECT_EQ(evaluation.score.voxels(), 5U);
  EXPECT_EQ(evaluation.score.confusion(2, 1), 1U);
  EXPECT_EQ(evaluation.score.confusion(1, 0), 1U);  // unknown
  EXPECT_DOUBLE_EQ(evaluation.score.iou(1), 1.0 / 3);
  EXPECT_DOUBLE_EQ(evaluation.score.freeIou(), 2.0 / 3);
  EXPECT_DOUBLE_EQ(evaluation.known_free_iou, 1.0 / 2);  // of two free ones it knows one
  EXPECT_DOUBLE_EQ(evaluation.score.geometricIou(), 2.0 / 3);
  // Scores 0.9, 0.8 | unknown: one of each | 0.2 free: 2 of 3 occupied before, 1 of 2 free with it.
  EXPECT_DOUBLE_EQ(evaluation.occupancy.curve(0.5)->auc(), 0.5 * (2.0 / 3 + 1) / 2 + 0.5);
  EXPECT_EQ(evaluation.calibration.count(), 3U);
  EXPECT_DOUBLE_EQ(evaluation.calibration.brier(),
                   (0.04 + 0.01 + 0.01 + 0.04 + 0.09 + 0.01 + 0.01 + 0.36 + 0.49) / 3);
  EXPECT_DOUBLE_EQ(evaluation.occupancy_calibration.brier(), 2 * (0.04 + 0.04 + 0.01) / 3);
}

TEST(VoxelEvaluation, OfAMapWithoutClassesIsOfOccupancyAlone) {
  const VoxelTruth truth(mapOf({{{0, 0, 0}, 0}, {{1, 0, 0}, 1}, {{2, 0, 0}, 3}}));
  FakeMapper map(0.5, false);
  map.set({1, 0, 0}, {0.2, 0.8});
  map.set({2, 0, 0}, {0.9, 0.1});
  const VoxelEvaluation evaluation = evaluateVoxels(map, truth);
  EXPECT_EQ(evaluation.score.numberOfClasses(), 2);
  EXPECT_EQ(evaluation.score.confusion(1, 1), 1U);
  EXPECT_EQ(evaluation.score.confusion(1, 0), 1U);
  EXPECT_EQ(evaluation.score.confusion(0, 0), 1U);
  EXPECT_DOUBLE_EQ(evaluation.calibration.brier(), (2 * 0.04 + 2 * 0.81) / 2);
}

TEST(VoxelEvaluation, ATruthWithoutFreeVoxelsGivesNoCurve) {
  const VoxelTruth truth(mapOf({{{0, 0, 0}, 2}}));
  FakeMapper map(0.5, true);
  map.set({0, 0, 0}, {0, 0, 1, 0});
  map.set({1, 0, 0}, {0, 0, 1, 0});
  const VoxelEvaluation evaluation = evaluateVoxels(map, truth);
  EXPECT_DOUBLE_EQ(evaluation.score.iou(2), 0.5);
  EXPECT_EQ(evaluation.known, 2U);
  EXPECT_FALSE(evaluation.occupancy.curve(0.5));
  EXPECT_EQ(evaluation.calibration.count(), 0U);
}

}  // namespace
}  // namespace csom
