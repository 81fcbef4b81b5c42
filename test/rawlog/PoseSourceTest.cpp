// SPDX-License-Identifier: BSD-3-Clause
// Poses from logs and from files.
#include <csom/rawlog/PoseSource.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <cmath>
#include <limits>

#include "rawlog/LogFixtures.h"

namespace csom::test {
namespace {

using mrpt::poses::CPose3D;
using testing::HasSubstr;

/// The pose of every observation labelled `label` in the log.
std::vector<std::optional<CPose3D>> posesOf(const std::string& file,
                                            const std::optional<PoseChoice>& choice = {},
                                            const std::string& label = "lidar") {
  PoseSource source(choice, surveyRawlog(file));
  RawlogReader reader(file);
  std::vector<std::optional<CPose3D>> poses;
  while (const auto entry = reader.next()) {
    source.advance(*entry);
    for (const auto& observation : entry->observations) {
      if (observation->sensorLabel == label) poses.push_back(source.poseOf(*entry, *observation));
    }
  }
  return poses;
}

void expectNear(const std::optional<CPose3D>& pose, const CPose3D& expected) {
  ASSERT_TRUE(pose);
  EXPECT_LT((*pose - expected).norm(), 1e-9) << pose->asString();
  EXPECT_LT(std::abs(pose->yaw() - expected.yaw()), 1e-9) << pose->asString();
}

std::string configError(const std::string& file, const std::optional<PoseChoice>& choice = {}) {
  try {
    posesOf(file, choice);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(PoseTrack, InterpolatesAndNeverExtrapolates) {
  PoseTrack track;
  ASSERT_TRUE(track.add(10, CPose3D(0, 0, 0, 3.0, 0, 0)));
  ASSERT_TRUE(track.add(12, CPose3D(4, 0, 2, -3.0, 0, 0)));
  EXPECT_FALSE(track.at(9.999));
  EXPECT_FALSE(track.at(12.001));
  EXPECT_FALSE(track.at(std::nan("")));
  EXPECT_EQ(track.at(12)->x(), 4);
  const auto half = track.at(11);
  ASSERT_TRUE(half);
  EXPECT_NEAR(half->x(), 2, 1e-12);
  EXPECT_NEAR(half->z(), 1, 1e-12);
  // The short way round, through pi.
  EXPECT_NEAR(std::cos(half->yaw()), -1, 1e-9);
}

TEST(PoseTrack, A5_DoesNotInterpolateAcrossImplausibleGaps) {
  PoseTrack track;
  for (int i = 0; i < 10; ++i) track.add(0.2 * i, {1.0 * i, 0, 0, 0, 0, 0});
  track.add(3.7, {20, 0, 0, 0, 0, 0});  // 1.9 s behind: less than ten times 0.2 s
  track.add(6.0, {30, 0, 0, 0, 0, 0});  // 2.3 s
  track.add(100, {30, 0, 0, 0, 0, 0});  // the robot stood
  EXPECT_TRUE(track.at(5)) << "as long as nobody limits gaps";
  track.limitGapsBySpacing();
  EXPECT_TRUE(track.at(2.5));
  EXPECT_FALSE(track.at(5));
  EXPECT_TRUE(track.at(6.0)) << "a pose of that very time";
  EXPECT_TRUE(track.at(50));
  const auto gap = track.gapAt(5);
  ASSERT_TRUE(gap);
  EXPECT_EQ(gap->before, 3.7);
  EXPECT_EQ(gap->after, 6.0);
  EXPECT_FALSE(track.gapAt(6.0));
  EXPECT_FALSE(track.gapAt(-1));

  PoseTrack two;
  two.add(0, {0, 0, 0, 0, 0, 0});
  two.add(59, {1, 0, 0, 0, 0, 0});
  two.limitGapsBySpacing();
  EXPECT_TRUE(two.at(30)) << "two poses have no other spacing than their own";
  two.add(7200, {2, 0, 0, 0, 0, 0});
  two.limitGapsBySpacing();
  EXPECT_FALSE(two.at(3600)) << "but a minute is the most";
}

TEST(PoseTrack, RefusesWhatIsNotFinite) {
  PoseTrack track;
  EXPECT_FALSE(track.add(std::numeric_limits<double>::infinity(), CPose3D()));
  CPose3D pose;
  pose.x(std::nan(""));
  EXPECT_FALSE(track.add(1, pose));
  EXPECT_TRUE(track.empty());
}

TEST(PoseChoice, IsReadAndWritten) {
  for (const char* text : {"odometry", "robot-pose", "robot-pose:truth", "tum:a.txt", "kitti:a:b",
                           "simplemap:x.simplemap", "icp", "icp:lidar"})
    EXPECT_EQ(PoseChoice::parse(text).toString(), text);
  for (const char* text : {"", "gps", "tum", "tum:", "odometry:x", "kitti:", "simplemap"})
    EXPECT_THROW(PoseChoice::parse(text), ConfigError) << text;
}

TEST(PoseSource, PrefersRobotPosesThenOdometry) {
  const TempFolder folder;
  Entries entries = driveEntries(2);
  entries.push_back(odometry(101, 7, 7, 0));
  const auto both = writeLog(folder / "both.rawlog", entries);
  EXPECT_EQ(PoseSource({}, surveyRawlog(both)).choice().toString(), "robot-pose:truth");
  const auto wheels = writeLog(folder / "wheels.rawlog",
                               {odometry(1, 0, 0, 0), wallCloud(1), odometry(2, 1, 0, 0)});
  EXPECT_EQ(PoseSource({}, surveyRawlog(wheels)).choice().toString(), "odometry");
  EXPECT_THAT(configError(writeLog(folder / "none.rawlog", {wallCloud(1)})),
              HasSubstr("neither robot poses nor odometry"));
}

TEST(PoseSource, InterpolatesRobotPosesInTime) {
  const TempFolder folder;
  const auto poses = posesOf(writeLog(
      folder / "a.rawlog", {wallCloud(9), robotPose(10, {0, 0, 0, 0, 0, 0}), wallCloud(10),
                            wallCloud(10.5), wallCloud(11.5), robotPose(11, {2, 0, 0, 1, 0, 0})}));
  ASSERT_EQ(poses.size(), 4u);
  EXPECT_FALSE(poses[0]) << "before the first pose";
  expectNear(poses[1], {0, 0, 0, 0, 0, 0});
  expectNear(poses[2], {1, 0, 0, 0.5, 0, 0});
  EXPECT_FALSE(poses[3]) << "after the last pose";
}

TEST(PoseSource, TakesTheRobotPoseOfTheSameSensoryFrame) {
  const TempFolder folder;
  const auto poses = posesOf(
      writeLog(folder / "a.rawlog",
               {movement(1, 0, 0), frameOf({wallCloud(5), robotPose(1, {3, 4, 5, 0, 0, 0})})}));
  ASSERT_EQ(poses.size(), 1u);
  expectNear(poses[0], {3, 4, 5, 0, 0, 0});
}

TEST(PoseSource, WantsALabelWhereThereAreSeveral) {
  const TempFolder folder;
  const auto file =
      writeLog(folder / "a.rawlog", {robotPose(1, {1, 0, 0, 0, 0, 0}, "gps"),
                                     robotPose(1, {2, 0, 0, 0, 0, 0}, "slam"), wallCloud(1)});
  EXPECT_THAT(configError(file), HasSubstr("'gps', 'slam'"));
  EXPECT_THAT(configError(file, PoseChoice::parse("robot-pose:foo")), HasSubstr("'gps', 'slam'"));
  expectNear(posesOf(file, PoseChoice::parse("robot-pose:slam")).at(0), {2, 0, 0, 0, 0, 0});
}

TEST(PoseSource, IntegratesActions) {
  const TempFolder folder;
  const auto poses =
      posesOf(writeLog(folder / "a.rawlog", {movement(1, 0, M_PI / 2), frameOf({wallCloud(1)}),
                                             movement(1, 0, 0), frameOf({wallCloud(2)})}));
  ASSERT_EQ(poses.size(), 2u);
  expectNear(poses[0], {1, 0, 0, M_PI / 2, 0, 0});
  expectNear(poses[1], {1, 1, 0, M_PI / 2, 0, 0});
}

TEST(PoseSource, InterpolatesOdometry) {
  const TempFolder folder;
  const auto poses = posesOf(
      writeLog(folder / "a.rawlog", {odometry(1, 0, 0, 0), wallCloud(1.25), odometry(2, 4, 8, 0)}));
  expectNear(poses.at(0), {1, 2, 0, 0, 0, 0});
}

TEST(PoseSource, ReadsTumFilesByTimeAndKittiFilesByScan) {
  const TempFolder folder;
  writeBytes(folder / "tum.txt", "# t x y z qx qy qz qw\n1 0 0 0 0 0 0 1\n3 2 4 6 0 0 0 1\n");
  writeBytes(folder / "kitti.txt", "1 0 0 7 0 1 0 8 0 0 1 9\n1 0 0 1 0 1 0 2 0 0 1 3\n");
  const auto log = writeLog(folder / "a.rawlog", {wallCloud(2), wallCloud(3), wallCloud(4)});
  const auto tum = posesOf(log, PoseChoice::parse("tum:" + (folder / "tum.txt")));
  expectNear(tum.at(0), {1, 2, 3, 0, 0, 0});
  expectNear(tum.at(1), {2, 4, 6, 0, 0, 0});
  EXPECT_FALSE(tum.at(2));
  const auto two = writeLog(folder / "b.rawlog", {wallCloud(2), wallCloud(3)});
  const auto kitti = posesOf(two, PoseChoice::parse("kitti:" + (folder / "kitti.txt")));
  expectNear(kitti.at(0), {7, 8, 9, 0, 0, 0});
  expectNear(kitti.at(1), {1, 2, 3, 0, 0, 0});
  EXPECT_THROW(posesOf(log, PoseChoice::parse("kitti:" + (folder / "kitti.txt"))), ConfigError)
      << "more scans than lines";
}

TEST(PoseSource, RefusesBadFilesOfPoses) {
  const TempFolder folder;
  const auto log = writeLog(folder / "a.rawlog", {wallCloud(2)});
  const std::string file = folder / "poses.txt";
  for (const char* text : {"", "1 0 0 0 0 0 0 nan\n", "1 0 0 0 0 0 0 2\n",
                           "2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", "1 0 0 0 0 0 0\n"}) {
    writeBytes(file, text);
    EXPECT_THROW(posesOf(log, PoseChoice::parse("tum:" + file)), FileError) << text;
  }
  EXPECT_THROW(posesOf(log, PoseChoice::parse("kitti:" + (folder / "missing"))), FileError);
  EXPECT_THROW(posesOf(log, PoseChoice::parse("simplemap:" + log)), FileError);
}

TEST(PoseSource, TakesPosesOfASimplemap) {
  const TempFolder folder;
  mrpt::maps::CSimpleMap map;
  map.insert(mrpt::poses::CPose3DPDFGaussian(CPose3D(1, 0, 0, 0, 0, 0)), *frameOf({wallCloud(1)}));
  map.insert(mrpt::poses::CPose3DPDFGaussian(CPose3D(3, 0, 0, 0, 0, 0)), *frameOf({wallCloud(2)}));
  ASSERT_TRUE(map.saveToFile(folder / "m.simplemap"));
  const auto log = writeLog(folder / "a.rawlog", {wallCloud(1.5)});
  expectNear(posesOf(log, PoseChoice::parse("simplemap:" + (folder / "m.simplemap"))).at(0),
             {2, 0, 0, 0, 0, 0});
  expectNear(posesOf(folder / "m.simplemap").at(1), {3, 0, 0, 0, 0, 0});
}

TEST(PoseSource, CountsPosesThatAreNotFinite) {
  const TempFolder folder;
  CPose3D bad;
  bad.x(std::nan(""));
  const auto survey = surveyRawlog(
      writeLog(folder / "a.rawlog", {robotPose(1, bad), robotPose(2, CPose3D()), wallCloud(2)}));
  EXPECT_EQ(survey.invalid_poses, 1u);
  EXPECT_EQ(survey.robot_poses.at("truth").size(), 1u);
}

TEST(PoseSource, LabelsOfALogAreMadePrintable) {
  const TempFolder folder;
  const std::string log =
      writeLog(folder / "two.rawlog", {robotPose(1, {}, "a\x1b[2J"), robotPose(1, {}, "b")});
  try {
    PoseSource(std::nullopt, surveyRawlog(log));
    FAIL() << "no error";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("several labels ('a?[2J', 'b')"));
  }
}

}  // namespace
}  // namespace csom::test
