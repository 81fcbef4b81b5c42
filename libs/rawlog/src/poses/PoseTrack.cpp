// SPDX-License-Identifier: BSD-3-Clause
// Poses over time.
#include <csom/rawlog/PoseTrack.h>
#include <mrpt/math/slerp.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "poses/Median.h"

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
  if (!isPlausible(*before, *after)) return std::nullopt;
  const double share = (time - before->first) / (after->first - before->first);
  mrpt::math::TPose3D between;
  mrpt::math::slerp(before->second.asTPose(), after->second.asTPose(), share, between);
  return mrpt::poses::CPose3D(between);
}

std::optional<PoseGap> PoseTrack::gapAt(double time) const {
  if (!std::isfinite(time)) return std::nullopt;
  const auto after = poses_.lower_bound(time);
  if (after == poses_.end() || after == poses_.begin() || after->first == time) return std::nullopt;
  return PoseGap{std::prev(after)->first, after->first};
}

void PoseTrack::limitGapsBySpacing() {
  constexpr double kTimesTheSpacing = 10;
  constexpr double kAlwaysPlausible = 1;
  constexpr double kNeverPlausible = 60;
  if (poses_.size() < 2) return;
  std::vector<double> spacings;
  for (auto pose = std::next(poses_.begin()); pose != poses_.end(); ++pose)
    spacings.push_back(pose->first - std::prev(pose)->first);
  limitGaps(std::clamp(kTimesTheSpacing * detail::computeMedian(spacings), kAlwaysPlausible,
                       kNeverPlausible));
}

bool PoseTrack::isPlausible(const std::pair<const double, mrpt::poses::CPose3D>& before,
                            const std::pair<const double, mrpt::poses::CPose3D>& after) const {
  // Some loggers write no poses while the robot stands.
  constexpr double kSamePlace = 0.01;  // [m], [rad]
  if (after.first - before.first <= longest_gap_) return true;
  const mrpt::poses::CPose3D moved = after.second - before.second;
  return moved.norm() < kSamePlace && std::abs(moved.yaw()) < kSamePlace &&
         std::abs(moved.pitch()) < kSamePlace && std::abs(moved.roll()) < kSamePlace;
}

}  // namespace csom
