// SPDX-License-Identifier: BSD-3-Clause
// Poses over time.
#include <csom/rawlog/PoseTrack.h>
#include <mrpt/math/slerp.h>

#include <cmath>
#include <iterator>

namespace csom {
namespace {

bool finite(const mrpt::math::TPose3D& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && std::isfinite(p.yaw) &&
         std::isfinite(p.pitch) && std::isfinite(p.roll);
}

}  // namespace

bool PoseTrack::add(double time, const mrpt::poses::CPose3D& pose) {
  if (!std::isfinite(time) || !finite(pose.asTPose())) return false;
  poses_[time] = pose;
  return true;
}

std::optional<mrpt::poses::CPose3D> PoseTrack::at(double time) const {
  if (!std::isfinite(time)) return std::nullopt;
  const auto after = poses_.lower_bound(time);
  if (after == poses_.end()) return std::nullopt;
  if (after->first == time) return after->second;
  if (after == poses_.begin()) return std::nullopt;
  const auto before = std::prev(after);
  const double share = (time - before->first) / (after->first - before->first);
  mrpt::math::TPose3D between;
  mrpt::math::slerp(before->second.asTPose(), after->second.asTPose(), share, between);
  return mrpt::poses::CPose3D(between);
}

}  // namespace csom
