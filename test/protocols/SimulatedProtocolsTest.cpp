// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/protocols/SimulatedProtocols.h>
#include <gmock/gmock.h>

#include <algorithm>

#include "protocols/SmallInputs.h"

namespace csom {
namespace {

using test::smallWorld;
using testing::Contains;
using testing::Each;
using testing::Gt;
using testing::Not;

TEST(SimulatedProtocols, P4IsWhatTheSensorsLabelThemselves) {
  const test::TempFolder folder;
  const Scenario scenario = loadScenario(smallWorld(folder, test::kPointSampler));
  const Trial trial = structuredRoomTrials(scenario).front();
  ASSERT_EQ(trial.scans->size(), 2U);
  for (const Scan& scan : *trial.scans) {
    EXPECT_EQ(scan.points.size(), 1500U);
    EXPECT_THAT(scan.labels, Each(Gt(kFreeClass)));
    EXPECT_THAT(scan.labels, Contains(scenario.world.labels().classByName("table").value()));
  }
  EXPECT_TRUE(trial.scans->at(1).origin.isApprox(Eigen::Vector3d(1, 1, 0.8), 1e-5));
  EXPECT_TRUE(trial.truth->knowsFree());
  EXPECT_EQ(trial.truth->at({15, 10, 7}), kFreeClass);
  EXPECT_EQ(trial.options.resolution, 0.1);
  EXPECT_EQ(trial.options.free_space.mode, FreeSpace::Sampled);

  const TrialResult result = runTrial(trial, MethodSpec::parse("see-csom")).front();
  ASSERT_TRUE(result.voxels.roc_unknown_half);
  EXPECT_GT(result.voxels.roc_unknown_half->auc, 0.9);
  EXPECT_GT(result.voxels.calibration.count(), 1000U);
  EXPECT_FALSE(result.points);
  EXPECT_FALSE(result.seen);
}

TEST(SimulatedProtocols, P5SeesThroughItsCamerasAlone) {
  const test::TempFolder folder;
  const Scenario scenario =
      loadScenario(smallWorld(folder, std::string(test::kPointSampler) + test::kCamera));
  const auto trials = robotTrials(scenario);
  ASSERT_EQ(trials.size(), 2U);
  EXPECT_EQ(trials[0].variant, "true poses");
  EXPECT_EQ(trials[1].variant, "odometry");
  ASSERT_EQ(trials[0].scans->size(), 2U);
  const Scan& ahead = trials[0].scans->at(1);  // the camera looks along x, 90° wide
  EXPECT_GT(ahead.points.size(), 100U);
  EXPECT_LT(ahead.points.size(), 500U);
  for (const Eigen::Vector3f& point : ahead.points) {
    EXPECT_GT(point.x(), 0);
    EXPECT_LE(std::abs(point.y()), 1.01 * point.x());
  }
  EXPECT_THAT(ahead.labels, Each(Gt(kFreeClass)));

  // The wall behind both places was never seen; the one ahead was.
  EXPECT_EQ(trials[0].truth->at({0, 10, 7}), scenario.world.labels().classByName("wall"));
  EXPECT_FALSE(trials[0].seen_truth->at({0, 10, 7}));
  int seen_ahead = 0;
  for (int y = 1; y < 19; ++y)
    for (int z = 1; z < 14; ++z) seen_ahead += trials[0].seen_truth->at({29, y, z}) ? 1 : 0;
  EXPECT_GT(seen_ahead, 30);
  EXPECT_EQ(trials[0].seen_truth, trials[1].seen_truth);

  const TrialResult result = runTrial(trials[0], MethodSpec::parse("s-csm")).front();
  ASSERT_TRUE(result.seen);
  EXPECT_LT(result.seen->score.voxels(), result.voxels.score.voxels());
  EXPECT_GT(result.seen->known_share, result.voxels.known_share);
}

TEST(SimulatedProtocols, OdometryWithoutNoiseIsTheTruth) {
  const test::TempFolder folder;
  const auto trials = robotTrials(
      loadScenario(smallWorld(folder, std::string(test::kPointSampler) + test::kCamera)));
  for (std::size_t i = 0; i < 2; ++i) {
    const Scan& by_truth = trials[0].scans->at(i);
    const Scan& by_odometry = trials[1].scans->at(i);
    EXPECT_TRUE(by_truth.origin.isApprox(by_odometry.origin, 1e-5));
    ASSERT_EQ(by_truth.points.size(), by_odometry.points.size());
    for (std::size_t p = 0; p < by_truth.points.size(); ++p)
      ASSERT_TRUE(by_truth.points[p].isApprox(by_odometry.points[p], 1e-4f));
  }
}

TEST(SimulatedProtocols, P5WithoutACameraIsAnError) {
  const test::TempFolder folder;
  const Scenario scenario = loadScenario(smallWorld(folder, test::kPointSampler));
  EXPECT_THROW(robotTrials(scenario), ConfigError);
}

}  // namespace
}  // namespace csom
