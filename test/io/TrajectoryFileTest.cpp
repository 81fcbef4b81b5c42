// SPDX-License-Identifier: BSD-3-Clause
#include <csom/io/TrajectoryFile.h>

#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::HasSubstr;

class TrajectoryFileTest : public testing::Test {
 protected:
  std::string tumError(const std::string& text) const {
    writeBytes(file_, text);
    return fileErrorOf([&] { readTumTrajectory(file_); });
  }
  std::string kittiError(const std::string& text) const {
    writeBytes(file_, text);
    return fileErrorOf([&] { readKittiPoses(file_); });
  }

  TempFolder folder_;
  std::string file_ = folder_ / "poses.txt";
};

TEST_F(TrajectoryFileTest, ReadsTum) {
  writeBytes(file_,
             "# timestamp tx ty tz qx qy qz qw\n\n1305031098.6659 1 2 3 0 0 0.7071068 0.7071068\n"
             "1305031098.7 -1 0 0.5 0 0 0 1\r\n");
  const auto trajectory = readTumTrajectory(file_);
  ASSERT_EQ(trajectory.size(), 2U);
  EXPECT_EQ(trajectory[0].timestamp, 1305031098.6659);
  EXPECT_TRUE(
      (trajectory[0].pose * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 3, 3), 1e-12))
      << "a quarter turn to the left";
  EXPECT_EQ(trajectory[1].pose.translation(), Eigen::Vector3d(-1, 0, 0.5));
  EXPECT_NEAR(trajectory[0].pose.linear().determinant(), 1, 1e-12);
}

TEST_F(TrajectoryFileTest, WritesWhatItReads) {
  std::vector<TimedPose> trajectory(2);
  trajectory[0].timestamp = 1305031098.6659;
  trajectory[1].timestamp = 1305031098.7;
  trajectory[1].pose.translation() = Eigen::Vector3d(1.25, -2e3, 0.001);
  trajectory[1].pose.rotate(Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, 2, -3).normalized()));
  writeTumTrajectory(trajectory, file_);
  const auto again = readTumTrajectory(file_);
  ASSERT_EQ(again.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(again[i].timestamp, trajectory[i].timestamp);
    EXPECT_TRUE(again[i].pose.isApprox(trajectory[i].pose, 1e-9)) << i;
  }
  EXPECT_THROW(writeTumTrajectory(trajectory, folder_ / "none/poses.tum"), FileError);
}

TEST_F(TrajectoryFileTest, ReadsKitti) {
  writeBytes(file_, "1 0 0 4 0 1 0 5 0 0 1 6\n0 -1 0 1.5 1 1e-6 0 2 0 0 1 3\n");
  const auto poses = readKittiPoses(file_);
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[0].value().translation(), Eigen::Vector3d(4, 5, 6));
  EXPECT_TRUE(poses[1].value().linear().isUnitary(1e-12)) << "made an exact rotation";
  EXPECT_TRUE(
      (poses[1].value() * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1.5, 3, 3), 1e-5));
}

TEST_F(TrajectoryFileTest, LinesOfKittiAreFramesAlsoIfTheyAreBlank) {
  const std::string pose = "1 0 0 4 0 1 0 5 0 0 1 6\n";
  writeBytes(file_, "\n" + pose + " \r\n" + pose + "\n\n");
  const auto poses = readKittiPoses(file_);
  ASSERT_EQ(poses.size(), 4U) << "what is blank at the end is no frame";
  EXPECT_FALSE(poses[0]);
  EXPECT_TRUE(poses[1]);
  EXPECT_FALSE(poses[2]);
  EXPECT_TRUE(poses[3]);
  writeBytes(file_, pose + "# the second\n" + pose);
  EXPECT_THAT(fileErrorOf([&] { readKittiPoses(file_); }), HasSubstr("line 2: a comment"));
}

TEST_F(TrajectoryFileTest, BadTumLinesAreNamed) {
  EXPECT_THAT(tumError(""), HasSubstr("poses.txt: holds no pose"));
  EXPECT_THAT(tumError("# only\n"), HasSubstr("holds no pose"));
  EXPECT_THAT(tumError("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0\n"),
              HasSubstr("line 2: 7 columns, expected the 8 numbers"));
  EXPECT_THAT(tumError("1 0 0 0 0 0 0 1 9\n"), HasSubstr("line 1: 9 columns"));
  EXPECT_THAT(tumError("1 0 zero 0 0 0 0 1\n"), HasSubstr("column 3 is 'zero'"));
  EXPECT_THAT(tumError("1 inf 0 0 0 0 0 1\n"), HasSubstr("column 2 is 'inf'"));
  EXPECT_THAT(tumError("nan 0 0 0 0 0 0 1\n"), HasSubstr("column 1 is 'nan'"));
  EXPECT_THAT(tumError("1 0 0 0 0 0 0 0\n"), HasSubstr("the quaternion has length 0"));
  EXPECT_THAT(tumError("1 0 0 0 1 0 0 1\n"), HasSubstr("the quaternion has length 1.41"));
  EXPECT_THAT(tumError("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"), HasSubstr("line 2: time 1.0"));
  EXPECT_THAT(tumError("2 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n"), HasSubstr("sort the file"));
}

TEST_F(TrajectoryFileTest, BadKittiLinesAreNamed) {
  EXPECT_THAT(kittiError("\n"), HasSubstr("holds no pose"));
  EXPECT_THAT(kittiError("1 0 0 4 0 1 0 5 0 0 1\n"), HasSubstr("line 1: 11 columns"));
  EXPECT_THAT(kittiError("1 0 0 4 0 1 0 5 0 0 1 1e999\n"), HasSubstr("column 12 is '1e999'"));
  EXPECT_THAT(kittiError("1 0 0 4 0 1 0 5 0 0 1 6\n1 0 0 4 0 1 0 5 0 0 2 6\n"),
              HasSubstr("line 2: columns 1-3, 5-7 and 9-11 are not a rotation"));
}

}  // namespace
}  // namespace csom::test
