// SPDX-License-Identifier: BSD-3-Clause
#include <csom/protocols/RoomProtocols.h>
#include <gmock/gmock.h>

#include "protocols/SmallInputs.h"

namespace csom {
namespace {

using test::smallRoom;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kResolution = 0.05;

TrialResult lastResult(const Trial& trial, const std::string& method) {
  return runTrial(trial, MethodSpec::parse(method)).back();
}

TEST(RoomProtocols, P1IsOneScanAtEachDensity) {
  const auto trials = roomDensityTrials(smallRoom(), {0.05, 0.20}, kResolution);
  ASSERT_EQ(trials.size(), 2U);
  EXPECT_EQ(trials[1].variant, "ds 0.20");
  ASSERT_EQ(trials[0].scans->size(), 1U);
  EXPECT_EQ(trials[0].scans->front().points.size(), 4U * (800 + 100));
  EXPECT_EQ(trials[0].options.free_space.mode, FreeSpace::None);
}

TEST(RoomProtocols, CountingAtTheVoxelsOwnDensityIsTheTruth) {
  const auto trials = roomDensityTrials(smallRoom(), {0.05, 0.10}, kResolution);
  const TrialResult same = lastResult(trials[0], "s-csm");
  EXPECT_DOUBLE_EQ(same.voxels.score.weightedAverageIou(), 1);
  EXPECT_DOUBLE_EQ(same.voxels.score.accuratenessBox(), 1);
  EXPECT_EQ(same.voxels.score.truthCount(1), 800U);
  ASSERT_TRUE(same.points);
  EXPECT_DOUBLE_EQ(same.points->accuracy(), 1);
  EXPECT_DOUBLE_EQ(same.points->coverage(), 1);
  EXPECT_FALSE(same.voxels.roc_unknown_half);
  // A centroid for each 2×1×2 voxels of the wall and 2×2 of the table hits one voxel of the four.
  const TrialResult coarse = lastResult(trials[1], "s-csm");
  EXPECT_DOUBLE_EQ(coarse.voxels.score.weightedAverageIou(), 0.25);
  EXPECT_DOUBLE_EQ(coarse.points->coverage(), 0.25);
  EXPECT_DOUBLE_EQ(coarse.points->coveredAccuracy(), 1);
}

TEST(RoomProtocols, P2IsAScanACloud) {
  const auto trials = roomObjectTrials(smallRoom(), {0.05}, kResolution);
  ASSERT_EQ(trials.size(), 1U);
  ASSERT_EQ(trials[0].scans->size(), 2U);
  EXPECT_EQ(trials[0].scans->at(1).labels.front(), 3);
  const TrialResult result = lastResult(trials[0], "s-csm");
  EXPECT_EQ(result.scans, 2U);
  EXPECT_DOUBLE_EQ(result.voxels.score.weightedAverageIou(), 1);
}

TEST(RoomProtocols, P6RepeatsARandomShareWithNoise) {
  RepetitionOptions options;
  options.scans = 4;
  options.share = 0.25;
  options.sigma = 0.001;
  options.checkpoints = {1, 4};
  const Trial trial = roomRepetitionTrials(smallRoom(), 0.05, kResolution, options).front();
  ASSERT_EQ(trial.scans->size(), 4U);
  const Scan& first = trial.scans->at(0);
  EXPECT_NEAR(static_cast<double>(first.points.size()), 900, 100);  // 4 σ = 104
  EXPECT_NE(first.points.size(), trial.scans->at(1).points.size());
  double squares = 0;
  for (const Eigen::Vector3f& point : first.points) {
    // Points lie at 0.015 and 0.035 m in their voxels along x.
    const double in_voxel = point.x() / kResolution - std::floor(point.x() / kResolution);
    const double error = kResolution * std::min(std::abs(in_voxel - 0.3), std::abs(in_voxel - 0.7));
    squares += error * error;
  }
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(first.points.size())), 0.001, 0.0001);

  const auto results = runTrial(trial, MethodSpec::parse("s-csm"));
  ASSERT_EQ(results.size(), 2U);
  EXPECT_EQ(results[0].scans, 1U);
  EXPECT_EQ(results[1].scans, 4U);
  // A voxel is missed with probability 0.75⁴ by one scan, 0.75¹⁶ by four.
  EXPECT_NEAR(results[0].voxels.score.geometricRecall(), 1 - 0.316, 0.06);
  EXPECT_NEAR(results[1].voxels.score.geometricRecall(), 1 - 0.010, 0.02);

  const Trial again = roomRepetitionTrials(smallRoom(), 0.05, kResolution, options).front();
  EXPECT_EQ(again.scans->at(3).points, trial.scans->at(3).points);
}

TEST(RoomProtocols, ReadsCloudsInNaturalOrderAndTellsWhatItLeavesOut) {
  const test::TempFolder folder;
  test::writeBytes(folder / "10.pcd", test::pcdFile("0 0 0 2\n", 1));
  test::writeBytes(folder / "2.pcd", test::pcdFile("0 0 0 1 -1\n1 0 0 77\nnan 0 0 1\n", 3));
  const Room room = readRoom(folder.path(), test::labelsOf("stanford"));
  ASSERT_EQ(room.clouds.size(), 2U);
  EXPECT_THAT(room.clouds[0].labels, ElementsAre(1, kFreeClass));
  EXPECT_THAT(room.clouds[1].labels, ElementsAre(2));
  EXPECT_THAT(room.warnings,
              ElementsAre(HasSubstr("1 rows that are no points"),
                          HasSubstr("ignored surplus columns of 1 rows"),
                          HasSubstr("1 points with labels that the label set 'stanford'")));
}

TEST(RoomProtocols, CloudsWithoutLabelsAreAnError) {
  const test::TempFolder folder;
  std::string text = test::pcdFile("0 0 0 1\n", 1);
  text.replace(text.find("label"), 5, "other");
  test::writeBytes(folder / "1.pcd", text);
  const auto labels = test::labelsOf("stanford");
  EXPECT_THAT(test::fileErrorOf([&] { readRoom(folder.path(), labels); }),
              HasSubstr("1.pcd: has no field 'label'"));
  EXPECT_THAT(test::fileErrorOf([&] { readRoom(folder / "none", labels); }),
              HasSubstr("no such folder"));
}

}  // namespace
}  // namespace csom
