// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/VoxelScore.h>
#include <gtest/gtest.h>

#include "eval/LabelledVoxels.h"

namespace csom {
namespace {

using test::mapOf;

TEST(VoxelScore, CountsAgainstAPointCloud) {
  const SemanticMap truth = mapOf({{{0, 0, 0}, 1}, {{1, 0, 0}, 1}, {{2, 0, 0}, 1}, {{3, 0, 0}, 2}});
  // Right, right, missed, wrong class, beside the truth, and far beyond the padded box.
  const SemanticMap map =
      mapOf({{{0, 0, 0}, 1}, {{1, 0, 0}, 1}, {{3, 0, 0}, 1}, {{0, 1, 0}, 2}, {{40, 0, 0}, 3}});
  const VoxelScore score(map, truth, 0.5);
  EXPECT_EQ(score.voxels(), 6U * 3U * 3U);  // 4×1×1 voxels and one of padding all around
  EXPECT_EQ(score.truthCount(1), 3U);
  EXPECT_EQ(score.predictedCount(3), 0U);
  EXPECT_EQ(score.confusion(2, 1), 1U);
  EXPECT_EQ(score.confusion(1, 0), 1U);
  EXPECT_EQ(score.confusion(0, 2), 1U);
  EXPECT_DOUBLE_EQ(score.iou(1), 2.0 / 4);
  EXPECT_DOUBLE_EQ(score.iou(2), 0);
  EXPECT_DOUBLE_EQ(score.precision(1), 2.0 / 3);
  EXPECT_DOUBLE_EQ(score.recall(1), 2.0 / 3);
  EXPECT_DOUBLE_EQ(score.f1(1), 4.0 / 6);
  EXPECT_DOUBLE_EQ(score.weightedAverageIou(), (3 * 0.5 + 1 * 0) / 4);
  EXPECT_DOUBLE_EQ(score.macroF1(), (4.0 / 6 + 0) / 2);
  EXPECT_DOUBLE_EQ(score.geometricIou(), 3.0 / 5);
  EXPECT_DOUBLE_EQ(score.geometricPrecision(), 3.0 / 4);
  EXPECT_DOUBLE_EQ(score.geometricRecall(), 3.0 / 4);
  EXPECT_DOUBLE_EQ(score.geometricF1(), 3.0 / 4);
  EXPECT_DOUBLE_EQ(score.freeIou(), 49.0 / 51);
  EXPECT_DOUBLE_EQ(score.accuratenessOccupied(), 2.0 / 5);
  EXPECT_DOUBLE_EQ(score.accuratenessBox(), (2.0 + 49) / 54);
}

TEST(VoxelScore, LeavesOutWhatASimulatedTruthDoesNotKnow) {
  const SemanticMap truth = mapOf({{{0, 0, 0}, 0}, {{1, 0, 0}, 1}});
  const SemanticMap map = mapOf({{{0, 0, 0}, 2}, {{1, 0, 0}, 1}, {{2, 0, 0}, 1}});
  const VoxelScore score(map, truth);
  EXPECT_EQ(score.voxels(), 2U);
  EXPECT_DOUBLE_EQ(score.iou(1), 1.0);
  EXPECT_EQ(score.confusion(0, 2), 1U);
  EXPECT_DOUBLE_EQ(score.geometricPrecision(), 0.5);
}

TEST(VoxelScore, EqualMapsScoreOne) {
  const SemanticMap map = mapOf({{{-5, 2, 7}, 3}, {{1, 0, 0}, 1}});
  const VoxelScore score(map, map);
  EXPECT_DOUBLE_EQ(score.weightedAverageIou(), 1.0);
  EXPECT_DOUBLE_EQ(score.geometricIou(), 1.0);
  EXPECT_DOUBLE_EQ(score.accuratenessBox(), 1.0);
}

TEST(VoxelScore, MapsThatCannotBeComparedThrow) {
  const SemanticMap map = mapOf({{{0, 0, 0}, 1}});
  EXPECT_THROW(VoxelScore(map, mapOf({{{0, 0, 0}, 1}}, 0.25)), std::invalid_argument);
  EXPECT_THROW(VoxelScore(map, mapOf({})), std::invalid_argument);
}

}  // namespace
}  // namespace csom
