// SPDX-License-Identifier: BSD-3-Clause
// Poses from scans alone: how near they come to the truth, and what is said of scans that do not
// fit.
#include <csom/rawlog/MappingRun.h>
#include <csom/rawlog/ScanRegistration.h>
#include <csom/rawlog/Simulation.h>
#include <mrpt/obs/CObservationImage.h>

#include <random>

#include "rawlog/LogFixtures.h"
#include "rawlog/SimulatedDrive.h"

namespace csom::test {
namespace {

using mrpt::poses::CPose3D;
using testing::HasSubstr;
using Points = std::vector<Eigen::Vector3f>;

/// A street corner: ground, two house fronts and a pole, seen from `x` metres along the street.
/// Each scan hits other points of them.
Points cornerSeenFrom(float x) {
  std::mt19937 random(static_cast<unsigned>(1000 * x));
  std::uniform_real_distribution<float> across(-20, 20);
  std::uniform_real_distribution<float> up(-1.5F, 4);
  Points points;
  for (int i = 0; i < 6000; ++i) {
    points.emplace_back(across(random) - x, across(random), -1.5F);
    points.emplace_back(across(random) - x, 8, up(random));
    points.emplace_back(15 - x, across(random), up(random));
    const float turn = across(random);
    points.emplace_back(4 - x + 0.2F * std::cos(turn), -4 + 0.2F * std::sin(turn), up(random));
  }
  return points;
}

Points cloudOfNothing(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> coordinate(-60, 60);
  Points points(3000);
  for (Eigen::Vector3f& point : points)
    point = {coordinate(random), coordinate(random), coordinate(random)};
  return points;
}

TEST(ScanRegistration, FollowsAConstantVelocity) {
  ScanRegistration registration;
  for (int i = 0; i < 6; ++i) {
    const float x = 0.7F * static_cast<float>(i);
    const auto result = registration.add(0.1 * i, cornerSeenFrom(x));
    EXPECT_EQ(result.doubt, "");
    EXPECT_NEAR(result.pose.x(), x, 0.05) << i;
    EXPECT_NEAR(result.pose.y(), 0, 0.02) << i;
    EXPECT_NEAR(result.pose.z(), 0, 0.02) << i;
  }
  EXPECT_NEAR(registration.predictedMotion(0.2).x(), 1.4, 0.1);
  EXPECT_EQ(registration.predictedMotion(60).x(), 0) << "nobody knows after a minute";
}

TEST(ScanRegistration, WhatDoesNotFitGetsThePredictedPoseAndIsDoubtful) {
  ScanRegistration registration;
  registration.add(0.0, cornerSeenFrom(0));
  registration.add(0.1, cornerSeenFrom(0.7F));
  const CPose3D last = registration.add(0.2, cornerSeenFrom(1.4F)).pose;
  const CPose3D expected = last + registration.predictedMotion(0.1);
  const auto strange = registration.add(0.3, cloudOfNothing(1));
  EXPECT_THAT(strange.doubt, HasSubstr("% of it lies on earlier scans"));
  EXPECT_NEAR((strange.pose - expected).norm(), 0, 1e-6);
  const auto few = registration.add(0.4, Points(50, Eigen::Vector3f(5, 5, 5)));
  EXPECT_THAT(few.doubt, HasSubstr("of its points can be used"));
  const auto back = registration.add(0.5, cornerSeenFrom(3.5F));
  EXPECT_EQ(back.doubt, "") << "one scan that does not fit spoils nothing";
  EXPECT_NEAR(back.pose.x(), 3.5, 0.05);
}

TEST(ScanRegistration, BeginsANewSubmapWhenItIsLost) {
  ScanRegistration registration;
  registration.add(0, cornerSeenFrom(0));
  const Points elsewhere = cloudOfNothing(1);
  for (int i = 1; i <= 4; ++i) {
    const auto lost = registration.add(i, elsewhere);
    EXPECT_THAT(lost.doubt, testing::EndsWith("lies on earlier scans")) << i;
  }
  EXPECT_THAT(registration.add(5, elsewhere).doubt,
              testing::EndsWith("the submap begins anew here"));
  EXPECT_EQ(registration.add(6, elsewhere).doubt, "");
}

TEST(ScanRegistration, PointsThatAreNotFiniteAreNoPoints) {
  Points points = cornerSeenFrom(0);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  ScanRegistration clean;
  ScanRegistration with_nan;
  clean.add(0, points);
  points.emplace_back(nan, 1.0F, 2.0F);
  points.emplace_back(std::numeric_limits<float>::infinity(), 1.0F, 2.0F);
  with_nan.add(0, points);
  const CPose3D a = clean.add(0.1, cornerSeenFrom(0.5F)).pose;
  const CPose3D b = with_nan.add(0.1, cornerSeenFrom(0.5F)).pose;
  EXPECT_EQ(a, b);
}

// --- whole logs ----------------------------------------------------------------------------------

class RegisteredLog : public testing::Test {
 protected:
  void simulate(const std::string& lidar_keys = ", range_sigma: 0.02") {
    SimulationOptions options;
    options.format = RawlogFormat::Observations;
    options.trajectory_file = folder / "truth.tum";
    simulateRawlog(yardDrive(folder, lidar_keys), log, options);
  }
  MappingResult mapped(const std::string& file, const std::string& poses = "icp",
                       const std::function<void(const MappingProgress&)>& on_progress = {}) const {
    MappingRequest request;
    request.logs = {file};
    request.config_file = writeConfig(folder, "point_labels = none\nunlabelled_class = wall");
    request.poses = PoseChoice::parse(poses);
    request.keep_key_frames = true;
    return mapLogs(request, on_progress);
  }
  std::string errorOf(const std::string& file, const std::string& poses) const {
    try {
      mapped(file, poses);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no error";
  }

  const TempFolder folder;
  const std::string log = folder / "drive.rawlog";
};

TEST_F(RegisteredLog, StaysNearTheTruth) {
  simulate();
  const MappingResult result = mapped(log);
  const auto truth = readTumTrajectory(folder / "truth.tum");
  ASSERT_EQ(result.trajectory.size(), truth.size());
  ASSERT_GE(truth.size(), 20U);
  EXPECT_EQ(result.registration->statistics.scans, truth.size());
  EXPECT_EQ(result.registration->statistics.doubtful, 0U);
  EXPECT_TRUE(result.trajectory[0].pose.isApprox(Eigen::Isometry3d::Identity()));
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(result.trajectory[i].timestamp, truth[i].timestamp, 1e-5);
    const Eigen::Isometry3d moved = truth[0].pose.inverse() * truth[i].pose;
    const Eigen::Isometry3d error = moved.inverse() * result.trajectory[i].pose;
    EXPECT_LT(error.translation().norm(), 0.10) << "scan " << i;
    EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle(), 0.015) << "scan " << i;
  }
}

TEST_F(RegisteredLog, TheSameLogGivesTheSamePosesBitForBit) {
  simulate();
  const MappingResult first = mapped(log);
  const MappingResult second = mapped(log);
  ASSERT_EQ(first.trajectory.size(), second.trajectory.size());
  for (std::size_t i = 0; i < first.trajectory.size(); ++i)
    EXPECT_EQ(first.trajectory[i].pose.matrix(), second.trajectory[i].pose.matrix());
}

/// The scans of `log` with an image before the first, halfway between any two, and after the last.
std::string withImages(const TempFolder& folder, const std::string& log) {
  const std::string file = folder / "images.rawlog";
  RawlogWriter writer(file);
  const auto write_image = [&](const mrpt::Clock::time_point& time) {
    mrpt::obs::CObservationImage image;
    image.sensorLabel = "camera";
    image.timestamp = time;
    image.image.resize(8, 8, mrpt::img::CH_GRAY);
    writer.write(image);
  };
  using std::chrono::milliseconds;
  RawlogReader reader(log);
  bool first = true;
  mrpt::Clock::time_point last;
  while (const auto entry = reader.next()) {
    for (const auto& observation : entry->observations) {
      if (observation->sensorLabel != "lidar") continue;
      last = observation->timestamp;
      if (first) write_image(last - milliseconds(50));
      first = false;
      writer.write(*observation);
      write_image(last + milliseconds(50));
    }
  }
  writer.commit();
  return file;
}

TEST_F(RegisteredLog, ImagesBetweenScansGetThePosesBetween) {
  simulate();
  const MappingResult result = mapped(withImages(folder, log));
  EXPECT_EQ(result.refused.at({"CObservationImage", "no pose at its time"}), 2U)
      << "one before the first scan, one after the last";
  ASSERT_EQ(result.key_frames.size(), 2 * result.trajectory.size() - 1);
  for (std::size_t i = 1; i + 1 < result.key_frames.size(); i += 2) {
    mrpt::poses::CPose3DPDF::ConstPtr pose;
    mrpt::obs::CSensoryFrame::ConstPtr frame;
    result.key_frames.get(i, pose, frame);
    ASSERT_EQ(frame->size(), 1U);
    EXPECT_EQ((*frame->begin())->sensorLabel, "camera");
    const Eigen::Vector3d halfway = (result.trajectory[i / 2].pose.translation() +
                                     result.trajectory[i / 2 + 1].pose.translation()) /
                                    2;
    EXPECT_NEAR(pose->getMeanVal().x(), halfway.x(), 1e-6);
    EXPECT_NEAR(pose->getMeanVal().y(), halfway.y(), 1e-6);
  }
}

TEST_F(RegisteredLog, TheLabelIsChosenOrAskedFor) {
  auto other = wallCloud(2);
  other->sensorLabel = "rear";
  const auto two = writeLog(folder / "two.rawlog", {wallCloud(1), other});
  EXPECT_THAT(errorOf(two, "icp"), HasSubstr("'lidar', 'rear'); choose one"));
  EXPECT_THAT(errorOf(two, "icp:front"), HasSubstr("no 3-D scans with the label 'front'"));
  EXPECT_EQ(mapped(two, "icp:rear").logs.at(0).poses.toString(), "icp:rear");
  const auto none = writeLog(folder / "none.rawlog", {odometry(1, 0, 0, 0)});
  EXPECT_THAT(errorOf(none, "icp"), HasSubstr("holds no 3-D scans"));
}

TEST_F(RegisteredLog, SeveralLogsHaveNoCommonPlaceToBegin) {
  const auto one = writeLog(folder / "one.rawlog", {wallCloud(1)});
  MappingRequest request;
  request.logs = {one, one};
  request.config_file = writeConfig(folder);
  request.poses = PoseChoice::parse("icp");
  EXPECT_THROW(mapLogs(request), ConfigError);
}

TEST_F(RegisteredLog, DoubtfulScansAreCountedAndSaid) {
  simulate();
  Entries entries;
  RawlogReader reader(log);
  while (const auto entry = reader.next()) {
    for (const auto& observation : entry->observations) {
      if (observation->sensorLabel == "lidar") entries.push_back(observation);
    }
  }
  auto strange = wallCloud(0);
  strange->timestamp = dynamic_cast<const mrpt::obs::CObservation&>(*entries.at(10)).timestamp +
                       std::chrono::milliseconds(50);
  entries.insert(entries.begin() + 11, strange);
  entries.insert(entries.begin() + 15, entries.at(3));
  const MappingResult result = mapped(writeLog(folder / "strange.rawlog", entries));
  EXPECT_EQ(result.registration->statistics.doubtful, 2U);
  EXPECT_EQ(result.registration->statistics.scans, entries.size());
  EXPECT_THAT(
      result.warnings,
      testing::IsSupersetOf(
          {testing::AllOf(HasSubstr("registration of scan 11 at t=15778368"),
                          HasSubstr("is doubtful: only")),
           testing::AllOf(HasSubstr("registration of scan 15 at t="),
                          HasSubstr("is doubtful: it is not later than the scan before"))}));
  EXPECT_EQ(result.trajectory.size(), entries.size() - 1);
}

TEST_F(RegisteredLog, AnErrorOfTheCallerEndsTheRun) {
  simulate();
  int calls = 0;
  const auto fail = [&](const MappingProgress&) {
    if (++calls == 3) throw std::runtime_error("enough");
  };
  try {
    mapped(log, "icp", fail);
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "enough");
  }
}

}  // namespace
}  // namespace csom::test
