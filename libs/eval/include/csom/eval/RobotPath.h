// SPDX-License-Identifier: BSD-3-Clause
// Where the simulated robot is at which time.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

namespace csom {

/// Pose of a robot on the plane z = 0: metres, radians, world frame.
struct PlanarPose {
  double x = 0;
  double y = 0;
  double yaw = 0;

  /// Of the robot in the world, z up.
  Eigen::Isometry3d isometry() const;
};

/// A drive at constant speed or a row of stations. Poses are multiples of 1 µm and 0.1 µrad, so
/// that the last bits of sines and cosines, which differ between processors, never show.
class RobotPath {
 public:
  /// Straight lines through `waypoints`, corners rounded by arcs of `turn_radius` [m], driven at
  /// `speed` [m/s]. Throws std::invalid_argument if there are fewer than two points, two successive
  /// ones coincide, an arc does not fit between its neighbours, or speed ≤ 0.
  static RobotPath drive(const std::vector<Eigen::Vector2d>& waypoints, double turn_radius,
                         double speed);
  /// Stays `dwell` seconds at each pose. Throws std::invalid_argument if there is none.
  static RobotPath stations(const std::vector<PlanarPose>& poses, double dwell);

  /// Seconds from start to end.
  double duration() const { return duration_; }
  /// Metres driven; 0 for stations.
  double length() const { return length_; }
  /// Pose `time` seconds after the start; beyond an end, that of the end.
  PlanarPose at(double time) const;

 private:
  /// A straight line (curvature 0) or an arc.
  struct Segment {
    PlanarPose start;
    double begin = 0;  ///< metres from the path's start
    double length = 0;
    double curvature = 0;  ///< 1/m, positive to the left
  };

  RobotPath() = default;
  void append(const PlanarPose& start, double length, double curvature);

  std::vector<Segment> segments_;
  std::vector<PlanarPose> stations_;
  double speed_ = 0;
  double dwell_ = 0;
  double duration_ = 0;
  double length_ = 0;
};

}  // namespace csom
