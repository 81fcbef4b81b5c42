// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/RobotPath.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace csom {
namespace {

constexpr double kPi = 3.14159265358979323846;

TEST(RobotPath, StraightDriveKeepsItsSpeed) {
  const RobotPath path = RobotPath::drive({{1, 2}, {4, 6}}, 1, 2.5);
  EXPECT_DOUBLE_EQ(path.length(), 5);
  EXPECT_DOUBLE_EQ(path.duration(), 2);
  const PlanarPose pose = path.at(1);
  EXPECT_NEAR(pose.x, 2.5, 1e-6);
  EXPECT_NEAR(pose.y, 4, 1e-6);
  EXPECT_NEAR(pose.yaw, std::atan2(4, 3), 1e-7);
}

TEST(RobotPath, CornerIsAnArcOfTheTurnRadius) {
  const RobotPath path = RobotPath::drive({{0, 0}, {10, 0}, {10, 10}}, 2, 1);
  EXPECT_NEAR(path.length(), 8 + kPi + 8, 1e-12);
  const PlanarPose middle = path.at(8 + kPi / 2);
  EXPECT_NEAR(middle.yaw, kPi / 4, 1e-6);
  EXPECT_NEAR(std::hypot(middle.x - 8, middle.y - 2), 2, 1e-5);
  const PlanarPose end = path.at(1e9);
  EXPECT_NEAR(end.x, 10, 1e-6);
  EXPECT_NEAR(end.y, 10, 1e-6);
}

TEST(RobotPath, DriveIsSmooth) {
  const RobotPath path =
      RobotPath::drive({{0, 0}, {10, 0}, {14, 8}, {2, 12}, {-6, 4}, {-6, -8}}, 1.5, 1);
  constexpr double kStep = 0.01;
  for (double t = 0; t + kStep < path.duration(); t += kStep) {
    const PlanarPose a = path.at(t);
    const PlanarPose b = path.at(t + kStep);
    EXPECT_NEAR(std::hypot(b.x - a.x, b.y - a.y), kStep, 1e-5);
    EXPECT_LT(std::abs(std::remainder(b.yaw - a.yaw, 2 * kPi)), 1.01 * kStep / 1.5 + 1e-6)
        << "heading jumps at " << t;
    const double along = std::atan2(b.y - a.y, b.x - a.x);
    EXPECT_LT(std::abs(std::remainder(along - a.yaw, 2 * kPi)), 0.005) << "drives sideways";
  }
}

TEST(RobotPath, StationsAreVisitedOneAfterTheOther) {
  const RobotPath path = RobotPath::stations({{1, 2, 0.5}, {3, 4, -0.5}}, 2);
  EXPECT_DOUBLE_EQ(path.duration(), 4);
  EXPECT_EQ(path.at(0).x, 1);
  EXPECT_EQ(path.at(1.99).yaw, 0.5);
  EXPECT_EQ(path.at(2).x, 3);
  EXPECT_EQ(path.at(99).y, 4);
}

TEST(RobotPath, PosesAreWholeMicrometres) {
  const RobotPath path = RobotPath::drive({{0, 0}, {10, 0}, {10, 10}}, 2, 1);
  for (double t = 0; t < path.duration(); t += 0.137) {
    const double micrometres = path.at(t).x * 1e6;
    EXPECT_NEAR(micrometres, std::round(micrometres), 1e-6);
  }
}

TEST(RobotPath, RefusesWhatCannotBeDriven) {
  EXPECT_THROW(RobotPath::drive({{0, 0}}, 1, 1), std::invalid_argument);
  EXPECT_THROW(RobotPath::drive({{0, 0}, {0, 0}}, 1, 1), std::invalid_argument);
  EXPECT_THROW(RobotPath::drive({{0, 0}, {1, 0}}, 1, 0), std::invalid_argument);
  EXPECT_THROW(RobotPath::drive({{0, 0}, {1, 0}}, 0, 1), std::invalid_argument);
  EXPECT_THROW(RobotPath::drive({{0, 0}, {1, 0}, {1, 9}}, 2, 1), std::invalid_argument);
  EXPECT_THROW(RobotPath::drive({{0, 0}, {9, 0}, {0, 0}}, 1, 1), std::invalid_argument) << "U turn";
  EXPECT_THROW(RobotPath::stations({}, 1), std::invalid_argument);
  EXPECT_THROW(RobotPath::stations({{0, 0, 0}}, 0), std::invalid_argument);
}

}  // namespace
}  // namespace csom
