// SPDX-License-Identifier: BSD-3-Clause
// Where a robot drives, found by laying each of its 3-D scans over those before it.
#pragma once

#include <csom/io/RunStatistics.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/poses/CPose3D.h>

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <string>
#include <vector>

namespace csom {

struct RegistrationReport {
  RegistrationStatistics statistics;
  std::vector<std::string> doubts;  ///< the first of them: scan, time and reason, a line each
};

/// Registers scans with MRPT's ICP (mrpt::slam::CICP) against a submap of the latest key frames,
/// from where a constant velocity would have brought the robot. The first scan's pose is the
/// identity. The same scans give the same poses, bit for bit. Not thread-safe.
///
/// What it cannot see: a place that looks alike along a direction (a tunnel, open ground), where
/// scans fit wherever they are laid.
class ScanRegistration {
 public:
  struct Result {
    mrpt::poses::CPose3D pose;  ///< of the robot; of a doubtful scan the predicted one
    std::string doubt;          ///< why the scan cannot be trusted, one line; empty if it can
  };

  /// `time` [s], later than that of the scan before; `points` in the frame of the robot [m].
  Result add(double time, const std::vector<Eigen::Vector3f>& points);

  /// How the robot is expected to move in `seconds` from its last pose on.
  mrpt::poses::CPose3D predictedMotion(double seconds) const;

 private:
  using Points = std::vector<Eigen::Vector3f>;

  struct KeyFrame {
    mrpt::poses::CPose3D pose;
    Points points;  ///< in the frame of the robot
  };

  Result registered(const Points& points, const mrpt::poses::CPose3D& predicted) const;
  void keepAsKeyFrame(const mrpt::poses::CPose3D& pose, Points points);
  void buildSubmap();

  std::deque<KeyFrame> key_frames_;      ///< the oldest first
  mrpt::maps::CSimplePointsMap submap_;  ///< in the frame of the newest key frame
  struct TimedPose {
    double time;
    mrpt::poses::CPose3D pose;
  };
  /// The last three. Motion is taken over two steps: over one, errors would not die out, as a scan
  /// that is de-skewed by too much motion is laid half of that too far back, so that the next
  /// motion is too small by as much.
  std::deque<TimedPose> last_;
  std::size_t doubtful_in_a_row_ = 0;
};

}  // namespace csom
