// SPDX-License-Identifier: BSD-3-Clause
// Poses over time.
#pragma once

#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <map>
#include <optional>

namespace csom {

/// Poses by time [s since 1970], interpolated between two of them and never extrapolated.
class PoseTrack {
 public:
  /// False if the pose or the time is not finite: it is not added. A later pose of the same time
  /// replaces the earlier.
  bool add(double time, const mrpt::poses::CPose3D& pose);
  /// Position linear, rotation by SLERP; exactly the added pose at an added time; nothing outside
  /// of the first and last time.
  std::optional<mrpt::poses::CPose3D> at(double time) const;

  /// True if `time` is not after the last pose.
  bool reaches(double time) const { return !poses_.empty() && time <= poses_.rbegin()->first; }

  const std::map<double, mrpt::poses::CPose3D>& poses() const { return poses_; }
  std::size_t size() const { return poses_.size(); }
  bool empty() const { return poses_.empty(); }

 private:
  std::map<double, mrpt::poses::CPose3D> poses_;
};

}  // namespace csom
