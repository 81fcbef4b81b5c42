// SPDX-License-Identifier: BSD-3-Clause
// Wheel odometry with the errors of MRPT's Gaussian motion model.
#pragma once

#include <csom/eval/Random.h>
#include <csom/eval/Scenario.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/poses/CPose2D.h>

namespace csom::detail {

/// Turns true poses into readings. Where the robot has not moved the reading is exactly 0.
class SimulatedOdometry {
 public:
  SimulatedOdometry(const OdometryNoise& noise, const PlanarPose& start, const Random& random);

  /// Moves to `pose` and returns the increment that the wheels report, in the frame of the last
  /// pose.
  mrpt::poses::CPose2D move(const PlanarPose& pose);
  /// The sum of all increments since the start.
  const mrpt::poses::CPose2D& reading() const { return reading_; }

  /// The motion model whose uncertainty is that of the increments. It never claims to be better
  /// than 1 mm and 0.01°: particle filters cannot sample from a distribution without width.
  mrpt::obs::CActionRobotMovement2D::TMotionModelOptions motionModel() const;

 private:
  OdometryNoise noise_;
  mrpt::poses::CPose2D last_;
  mrpt::poses::CPose2D reading_;
  Random random_;
};

}  // namespace csom::detail
