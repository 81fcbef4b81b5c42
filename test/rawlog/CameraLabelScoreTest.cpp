// SPDX-License-Identifier: BSD-3-Clause
// Labels from the camera in simulated worlds: how many are right, and what visibility costs.
#include <csom/core/Error.h>
#include <csom/core/Options.h>
#include <csom/rawlog/CameraLabelScore.h>
#include <csom/rawlog/Simulation.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <variant>

namespace csom {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string kCampusWorld = CSOM_SOURCE_DIR "/config/worlds/campus.yaml";
const std::string kCampusRawlog = CSOM_SOURCE_DIR "/rawlogs/campus.rawlog";

class CameraLabelScoreTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) /
              ("csom_camera_score_" + std::string(test->name()) + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  Scenario world(const std::string& sensors, const std::string& solids) const {
    std::ofstream(path("world.yaml"))
        << "label_set: " CSOM_SOURCE_DIR "/config/labels/simulator.yaml\n"
        << "seed: 3\ntruth: {resolution: 1, min: [0, 0, 0], max: [1, 1, 1]}\n"
        << "robot: {stations: [[0, 0, 0]], dwell: 0.5}\nsensors:\n"
        << sensors << "solids:\n"
        << solids;
    return loadScenario(path("world.yaml"));
  }

  CameraLabelScore simulateAndScore(const Scenario& scenario,
                                    const PointLabellingOptions& options = {},
                                    RawlogFormat format = RawlogFormat::SensoryFrames) const {
    SimulationOptions simulation;
    simulation.format = format;
    simulateRawlog(scenario, path("world.rawlog"), simulation);
    return scoreCameraLabels(scenario, path("world.rawlog"), options);
  }

  fs::path folder_;
};

std::string lidar(const std::string& more = "rate: 1") {
  return "  - {type: velodyne_vlp16, label: lidar, pose: [0, 0, 2, 0, 0, 0], range: [1, 50], " +
         more + "}\n";
}

const std::string kLidar = lidar();
const std::string kCamera =
    "  - {type: camera, label: camera, pose: [0, 0, 1.4, 0, 0, 0], rate: 1, width: 320, "
    "height: 240, horizontal_fov_deg: 90}\n";
const std::string kWall =
    "  - {shape: box, class: wall, center: [12, 0, 3], size: [1, 40, 12]}\n"
    "  - {shape: box, class: clutter, center: [4, 0, 1.2], size: [0.4, 2, 1.4]}\n";

std::size_t count(const FateCounts& fates, PointFate fate) {
  return fates[static_cast<std::size_t>(fate)];
}

TEST_F(CameraLabelScoreTest, LabelsOnTheCampusAreRight) {
  const CameraLabelScore score = scoreCameraLabels(loadScenario(kCampusWorld), kCampusRawlog);
  EXPECT_EQ(score.scans, 68u);
  EXPECT_EQ(score.scans_without_image, 0u);
  EXPECT_GT(score.all.in_view, 150000u);
  EXPECT_GE(score.all.correctShare(), 0.995);
  EXPECT_LE(score.all.lostShare(), 0.03);
  EXPECT_LT(score.all.naiveCorrectShare(), 0.97);
  EXPECT_GT(score.all.naiveCorrectShare(), 0.9);
}

/// The campus with another camera, and a third of the scans.
Scenario campusSeenBy(const std::function<void(CameraModel&)>& change) {
  Scenario scenario = loadScenario(kCampusWorld);
  for (SensorModel& sensor : scenario.sensors) {
    std::visit([](auto& model) { model.mount.rate = 0.5; }, sensor);
    if (auto* camera = std::get_if<CameraModel>(&sensor)) change(*camera);
  }
  return scenario;
}

TEST_F(CameraLabelScoreTest, MorePixelsMakeItEasier) {
  const CameraLabelScore score = simulateAndScore(campusSeenBy([](CameraModel& camera) {
    camera.width = 640;
    camera.height = 480;
  }));
  EXPECT_GE(score.all.correctShare(), 0.995);
  EXPECT_LE(score.all.lostShare(), 0.02);
  EXPECT_LT(score.all.naiveCorrectShare(), 0.98);
}

TEST_F(CameraLabelScoreTest, ACameraBesideTheLidar) {
  const CameraLabelScore score = simulateAndScore(campusSeenBy([](CameraModel& camera) {
    camera.width = 640;
    camera.height = 480;
    camera.mount.position = {0, -0.5, 1.8};
    camera.mount.pitch = 0;
  }));
  EXPECT_GE(score.all.correctShare(), 0.992);
  EXPECT_LE(score.all.lostShare(), 0.03);
  EXPECT_LT(score.all.naiveCorrectShare(), 0.97);
}

TEST_F(CameraLabelScoreTest, CountsWhatIsHidden) {
  const CameraLabelScore score = simulateAndScore(world(kLidar + kCamera, kWall));
  EXPECT_EQ(score.scans, 1u);
  const CameraLabelTally& all = score.all;
  EXPECT_LT(all.visible, all.in_view);
  EXPECT_GT(count(all.fates, PointFate::Hidden), 50u);
  EXPECT_EQ(count(all.visible_fates, PointFate::Hidden), 0u);
  EXPECT_EQ(all.naive_labelled, all.in_view);
  EXPECT_LT(all.naiveCorrectShare(), 0.97);
  EXPECT_GT(all.correctShare(), 0.995);

  CameraLabelTally sum;
  std::size_t fates = 0;
  for (const CameraLabelTally& of_class : score.by_class) sum += of_class;
  for (const std::size_t points : all.fates) fates += points;
  EXPECT_EQ(sum.in_view, all.in_view);
  EXPECT_EQ(sum.visible, all.visible);
  EXPECT_EQ(sum.correct, all.correct);
  EXPECT_EQ(sum.naive_correct, all.naive_correct);
  EXPECT_EQ(sum.lost, all.lost);
  EXPECT_EQ(fates, all.in_view);
  EXPECT_EQ(count(all.fates, PointFate::OutsideView), 0u);
}

TEST_F(CameraLabelScoreTest, WithoutRejectionsItIsTheNaiveProjection) {
  PointLabellingOptions naive;
  naive.visibility = false;
  naive.edge_margin = 0;
  const CameraLabelScore score = simulateAndScore(world(kLidar + kCamera, kWall), naive);
  EXPECT_EQ(score.all.correctShare(), score.all.naiveCorrectShare());
  EXPECT_EQ(score.all.lost, 0u);
}

TEST_F(CameraLabelScoreTest, RawlogsOfSingleObservationsAreScoredTheSame) {
  const Scenario scenario = world(kLidar + kCamera, kWall);
  const CameraLabelScore frames = simulateAndScore(scenario);
  const CameraLabelScore single = simulateAndScore(scenario, {}, RawlogFormat::Observations);
  EXPECT_EQ(single.scans, frames.scans);
  EXPECT_EQ(single.all.in_view, frames.all.in_view);
  EXPECT_EQ(single.all.correct, frames.all.correct);
}

TEST_F(CameraLabelScoreTest, ScansWithoutAnImageAreCounted) {
  const CameraLabelScore score = simulateAndScore(world(lidar("rate: 10") + kCamera, kWall));
  EXPECT_EQ(score.scans, 1u);
  EXPECT_EQ(score.scans_without_image, 4u);
}

TEST_F(CameraLabelScoreTest, WhatCannotBeScored) {
  const auto errorOf = [](const auto& action) -> std::string {
    try {
      action();
    } catch (const ConfigError& error) {
      return error.what();
    } catch (const FileError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(errorOf([&] { simulateAndScore(world(kLidar, kWall)); }), HasSubstr("type camera"));
  EXPECT_THAT(errorOf([&] { simulateAndScore(world(kCamera, kWall)); }),
              HasSubstr("intensity: class"));
  const std::string reflectivity = lidar("rate: 1, intensity: reflectivity");
  EXPECT_THAT(errorOf([&] { simulateAndScore(world(reflectivity + kCamera, kWall)); }),
              HasSubstr("intensity: class"));
  EXPECT_THAT(errorOf([&] { scoreCameraLabels(loadScenario(kCampusWorld), path("none")); }),
              HasSubstr("none"));
  EXPECT_THAT(errorOf([&] {
                scoreCameraLabels(loadScenario(kCampusWorld),
                                  CSOM_SOURCE_DIR "/rawlogs/room.rawlog");
              }),
              HasSubstr("no scan of 'lidar'"));
  PointLabellingOptions bad;
  bad.edge_margin = -1;
  EXPECT_THROW(scoreCameraLabels(loadScenario(kCampusWorld), kCampusRawlog, bad), OptionError);
}

TEST(CameraLabelTally, SharesOfNothing) {
  const CameraLabelTally none;
  EXPECT_EQ(none.correctShare(), 1);
  EXPECT_EQ(none.naiveCorrectShare(), 1);
  EXPECT_EQ(none.lostShare(), 0);
}

}  // namespace
}  // namespace csom
