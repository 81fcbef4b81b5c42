// SPDX-License-Identifier: BSD-3-Clause
// Poses over time.
#pragma once

#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace csom {

/// Two poses that follow each other, by their times [s since 1970].
struct PoseGap {
  double before = 0;
  double after = 0;
  double length() const { return after - before; }
};

/// Poses by time [s since 1970], interpolated between two of them and never extrapolated. Where was
/// a robot whose poses come every tenth of a second, in the middle of an hour without any? Such a
/// gap is not interpolated across.
class PoseTrack {
 public:
  /// False if the pose or the time is not finite: it is not added. A later pose of the same time
  /// replaces the earlier.
  bool add(double time, const mrpt::poses::CPose3D& pose);
  /// No gap longer than `seconds` is interpolated across, unless the robot is at the same place on
  /// both sides of it. Without a call all are.
  void limitGaps(double seconds) { longest_gap_ = seconds; }
  /// limitGaps() by what the track's own spacing makes plausible: ten times the median distance of
  /// two poses in time, but a second at least and a minute at most.
  void limitGapsBySpacing();
  /// Position linear, rotation by SLERP; exactly the added pose at an added time; nothing outside
  /// of the first and last time, and in a gap that is too long.
  std::optional<mrpt::poses::CPose3D> at(double time) const;
  /// The poses around a time that is that of none; nothing outside of the first and last time.
  std::optional<PoseGap> gapAt(double time) const;

  /// True if `time` is not after the last pose.
  bool reaches(double time) const { return !poses_.empty() && time <= poses_.rbegin()->first; }

  const std::map<double, mrpt::poses::CPose3D>& poses() const { return poses_; }
  std::size_t size() const { return poses_.size(); }
  bool empty() const { return poses_.empty(); }

 private:
  bool isPlausible(const std::pair<const double, mrpt::poses::CPose3D>& before,
                   const std::pair<const double, mrpt::poses::CPose3D>& after) const;

  double longest_gap_ = std::numeric_limits<double>::infinity();  ///< [s]
  std::map<double, mrpt::poses::CPose3D> poses_;
};

}  // namespace csom
