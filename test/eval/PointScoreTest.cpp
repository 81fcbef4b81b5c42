// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/PointScore.h>
#include <gtest/gtest.h>

namespace csom {
namespace {

VoxelEstimate estimate(ClassId class_id, const std::vector<double>& probabilities) {
  return {true, 1 - probabilities[0], class_id, probabilities, class_id};
}

TEST(PointScore, UnknownAndFreeAreNeverRight) {
  PointScore score(3);
  score.add(1, estimate(1, {0.1, 0.9, 0}));
  score.add(1, estimate(2, {0, 0.25, 0.75}));
  score.add(2, estimate(2, {0, 0, 1}));
  score.add(2, estimate(0, {0.6, 0, 0.4}));
  score.add(2, VoxelEstimate{});
  EXPECT_EQ(score.points(), 5U);
  EXPECT_DOUBLE_EQ(score.coverage(), 0.8);
  EXPECT_DOUBLE_EQ(score.accuracy(), 2.0 / 5);
  EXPECT_DOUBLE_EQ(score.coveredAccuracy(), 2.0 / 4);
  EXPECT_DOUBLE_EQ(score.meanIou(), (1.0 / 2 + 1.0 / 4) / 2);
  EXPECT_DOUBLE_EQ(score.coveredMeanIou(), (1.0 / 2 + 1.0 / 3) / 2);
  EXPECT_EQ(score.calibration().count(), 4U);
  EXPECT_DOUBLE_EQ(score.calibration().brier(),
                   (0.01 + 0.01 + 0.75 * 0.75 * 2 + 0 + 0.36 + 0.36) / 4);
}

TEST(PointScore, AVoxelThatIsHeldToBeFreeMayKnowItsSurface) {
  PointScore score(3);
  VoxelEstimate voxel = estimate(0, {0.6, 0, 0.4});
  voxel.surface_class = 2;
  score.add(2, voxel);
  score.add(1, voxel);
  EXPECT_DOUBLE_EQ(score.accuracy(), 0.5);
  EXPECT_DOUBLE_EQ(score.coveredAccuracy(), 0.5);
  EXPECT_DOUBLE_EQ(score.occupiedAccuracy(), 0);
}

TEST(PointScore, OfLabelsWithoutAMap) {
  PointScore score(3);
  score.add(1, ClassId{1});
  score.add(2, ClassId{1});
  EXPECT_DOUBLE_EQ(score.accuracy(), 0.5);
  EXPECT_DOUBLE_EQ(score.meanIou(), (0.5 + 0) / 2);
  EXPECT_DOUBLE_EQ(score.coverage(), 1);
  EXPECT_EQ(score.calibration().count(), 0U);
}

TEST(PointScore, NothingIsZero) {
  EXPECT_EQ(PointScore(3).accuracy(), 0);
  EXPECT_EQ(PointScore(3).coverage(), 0);
}

}  // namespace
}  // namespace csom
