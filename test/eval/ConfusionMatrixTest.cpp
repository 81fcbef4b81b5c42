// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/ConfusionMatrix.h>
#include <gmock/gmock.h>

#include <stdexcept>

namespace csom {
namespace {

using testing::ElementsAre;

/// Truth 1: 6 right, 2 taken for 2, 2 for free. Truth 2: 1 right, 1 taken for 1. Free: 3 right,
/// 1 taken for 3.
ConfusionMatrix example() {
  ConfusionMatrix matrix(4);
  matrix.add(1, 1, 6);
  matrix.add(1, 2, 2);
  matrix.add(1, 0, 2);
  matrix.add(2, 2);
  matrix.add(2, 1);
  matrix.add(0, 0, 3);
  matrix.add(0, 3);
  return matrix;
}

TEST(ConfusionMatrix, ScoresOfAClass) {
  const ConfusionMatrix matrix = example();
  EXPECT_EQ(matrix.total(), 16U);
  EXPECT_EQ(matrix.correct(), 10U);
  EXPECT_EQ(matrix.truthCount(1), 10U);
  EXPECT_EQ(matrix.predictedCount(1), 7U);
  EXPECT_DOUBLE_EQ(matrix.iou(1), 6.0 / 11);
  EXPECT_DOUBLE_EQ(matrix.precision(1), 6.0 / 7);
  EXPECT_DOUBLE_EQ(matrix.recall(1), 6.0 / 10);
  EXPECT_DOUBLE_EQ(matrix.f1(1), 12.0 / 17);
  EXPECT_DOUBLE_EQ(matrix.iou(0), 3.0 / 6);
  EXPECT_DOUBLE_EQ(matrix.accuracy(), 10.0 / 16);
}

TEST(ConfusionMatrix, MeansAreOverTheOccupiedClassesOfTheTruth) {
  const ConfusionMatrix matrix = example();
  EXPECT_THAT(matrix.classesInTruth(), ElementsAre(1, 2));  // 3 is only predicted
  EXPECT_DOUBLE_EQ(matrix.meanIou(), (6.0 / 11 + 1.0 / 4) / 2);
  EXPECT_DOUBLE_EQ(matrix.weightedAverageIou(), (10 * 6.0 / 11 + 2 * 1.0 / 4) / 12);
  EXPECT_DOUBLE_EQ(matrix.macroF1(), (12.0 / 17 + 2.0 / 5) / 2);
}

TEST(ConfusionMatrix, OccupancyForgetsClasses) {
  const ConfusionMatrix binary = example().occupancy();
  EXPECT_EQ(binary.numberOfClasses(), 2);
  EXPECT_EQ(binary.count(1, 1), 10U);
  EXPECT_EQ(binary.count(1, 0), 2U);
  EXPECT_EQ(binary.count(0, 1), 1U);
  EXPECT_EQ(binary.count(0, 0), 3U);
}

TEST(ConfusionMatrix, NothingIsZero) {
  const ConfusionMatrix matrix(3);
  EXPECT_EQ(matrix.iou(1), 0);
  EXPECT_EQ(matrix.f1(2), 0);
  EXPECT_EQ(matrix.meanIou(), 0);
  EXPECT_EQ(matrix.weightedAverageIou(), 0);
  EXPECT_EQ(matrix.accuracy(), 0);
}

TEST(ConfusionMatrix, ClassesThatItDoesNotHaveThrow) {
  ConfusionMatrix matrix(2);
  EXPECT_THROW(matrix.add(2, 0), std::out_of_range);
  EXPECT_THROW(matrix.add(0, 2), std::out_of_range);
  EXPECT_EQ(matrix.total(), 0U);
}

}  // namespace
}  // namespace csom
