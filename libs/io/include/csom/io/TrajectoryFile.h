// SPDX-License-Identifier: BSD-3-Clause
// Trajectories as text: the TUM and the KITTI format.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

namespace csom {

struct TimedPose {
  double timestamp = 0;                                    ///< seconds since 1970 (UTC)
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in the frame of the file [m]
};

/// TUM: lines `timestamp x y z qx qy qz qw`, times increasing, `#` comments. Quaternions are
/// normalised; one whose length is off by more than 1 % is an error. Throws FileError naming file
/// and line, also for a file without any pose.
std::vector<TimedPose> readTumTrajectory(const std::string& file);

/// As readTumTrajectory() takes it, with nanometres and nanoseconds. Throws FileError.
void writeTumTrajectory(const std::vector<TimedPose>& trajectory, const std::string& file);

/// KITTI: lines of 12 numbers, a 3×4 matrix row by row; line i, counted from 0, is the pose of
/// frame i, and nothing if it is blank: blank lines count, those at the end apart. The rotation is
/// replaced by the nearest exact one; a matrix farther than 1 % from any rotation is an error, and
/// so is a comment. Throws FileError naming file and line, also for a file without any pose.
std::vector<std::optional<Eigen::Isometry3d>> readKittiPoses(const std::string& file);

}  // namespace csom
