// SPDX-License-Identifier: BSD-3-Clause
// Where a robot drives, found by laying each of its 3-D scans over those before it.
#include <csom/io/Module.h>
#include <csom/rawlog/ScanRegistration.h>
#include <mrpt/poses/Lie/SE.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <utility>

#include "poses/EigenPose.h"
#include "poses/IcpModule.h"
#include "poses/ThinnedPoints.h"

namespace csom {
namespace {

using mrpt::poses::CPose3D;
using Points = std::vector<Eigen::Vector3f>;

// Chosen by measurement on HDL-64 scans of streets and simulated VLP-16 scans (docs/poses.md).
constexpr float kNearest = 2;              // [m] nearer points may be of the vehicle itself
constexpr float kFarthest = 80;            // [m]
constexpr float kScanSpacing = 0.5F;       // [m] without it, rings on the ground outweigh all else
constexpr float kSubmapSpacing = 0.1F;     // [m]
constexpr double kKeyFrameDistance = 0.5;  // [m] driven from one key frame to the next
constexpr double kKeyFrameAngle = 0.17;    // [rad]
constexpr std::size_t kKeyFrames = 20;

using detail::kLargestCorrection;
constexpr double kMinOverlap = 0.3;  // share of the scan's points that have a partner
constexpr std::size_t kMinPoints = 100;
constexpr double kLongestPrediction = 2;  // [s] nobody drives at the same speed for longer
/// After so many the submap is lost, and a new one begins where the robot is expected.
constexpr std::size_t kDoubtfulUntilLost = 5;

Points usable(const Points& points) {
  Points kept;
  kept.reserve(points.size());
  for (const Eigen::Vector3f& point : points) {
    const float distance = point.norm();
    if (distance >= kNearest && distance <= kFarthest) kept.push_back(point);
  }
  return kept;
}

mrpt::maps::CSimplePointsMap pointsMap(const Points& points) {
  mrpt::maps::CSimplePointsMap map;
  map.reserve(points.size());
  for (const Eigen::Vector3f& p : points) map.insertPointFast(p.x(), p.y(), p.z());
  map.mark_as_modified();
  return map;
}

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f %%", 100 * share);
  return text;
}

}  // namespace

ScanRegistration::Result ScanRegistration::add(double time, const Points& points) {
  Points kept = usable(points);
  const bool first = key_frames_.empty();
  const CPose3D predicted =
      last_.empty() ? CPose3D() : last_.back().pose + predictedMotion(time - last_.back().time);

  Result result{predicted, {}};
  if (!first) {
    result = registered(detail::thinned(kept, kScanSpacing), predicted);
  } else if (kept.size() < kMinPoints) {
    result.doubt = "it has only " + std::to_string(kept.size()) + " points";
  }

  last_.push_back({time, result.pose});
  if (last_.size() > 3) last_.pop_front();
  doubtful_in_a_row_ = result.doubt.empty() ? 0 : doubtful_in_a_row_ + 1;
  if (doubtful_in_a_row_ == kDoubtfulUntilLost) {
    key_frames_.clear();
    doubtful_in_a_row_ = 0;
    result.doubt += "; the submap begins anew here";
  }
  if (result.doubt.empty() || (key_frames_.empty() && kept.size() >= kMinPoints))
    keepAsKeyFrame(result.pose, std::move(kept));
  return result;
}

CPose3D ScanRegistration::predictedMotion(double seconds) const {
  if (last_.size() < 2 || std::abs(seconds) > kLongestPrediction) return {};
  using Motions = mrpt::poses::Lie::SE<3>;
  auto twist = Motions::log(last_.back().pose - last_.front().pose);
  twist *= seconds / (last_.back().time - last_.front().time);
  return Motions::exp(twist);
}

ScanRegistration::Result ScanRegistration::registered(const Points& points,
                                                      const CPose3D& predicted) const {
  Result result{predicted, {}};
  if (points.size() < kMinPoints) {
    result.doubt = "only " + std::to_string(points.size()) + " of its points can be used";
    return result;
  }
  const CPose3D& anchor = key_frames_.back().pose;
  const mrpt::maps::CSimplePointsMap scan = pointsMap(points);
  static const auto align_points =
      detail::functionOfModule<detail::AlignPoints>(detail::kIcpModule, detail::kAlignPoints);
  detail::Alignment alignment;
  align_points(submap_, scan, predicted - anchor, alignment);
  const CPose3D pose = anchor + alignment.pose;
  const double correction = (pose - predicted).norm();
  if (!(alignment.overlap >= kMinOverlap)) {
    result.doubt = percent(alignment.overlap) + " of it lies on earlier scans";
  } else if (!(correction <= kLargestCorrection)) {
    result.doubt = "it fits " + std::to_string(correction) + " m from where it was expected";
  } else {
    result.pose = pose;
  }
  return result;
}

void ScanRegistration::keepAsKeyFrame(const CPose3D& pose, Points points) {
  if (!key_frames_.empty()) {
    const auto since = mrpt::poses::Lie::SE<3>::log(pose - key_frames_.back().pose);
    const double angle = std::hypot(since[3], since[4], since[5]);
    if ((pose - key_frames_.back().pose).norm() < kKeyFrameDistance && angle < kKeyFrameAngle)
      return;
  }
  key_frames_.push_back({pose, detail::thinned(points, kSubmapSpacing)});
  if (key_frames_.size() > kKeyFrames) key_frames_.pop_front();
  buildSubmap();
}

void ScanRegistration::buildSubmap() {
  Points all;
  for (const KeyFrame& frame : key_frames_) {
    const Eigen::Isometry3f motion =
        detail::toEigen(frame.pose - key_frames_.back().pose).cast<float>();
    for (const Eigen::Vector3f& point : frame.points) all.emplace_back(motion * point);
  }
  submap_ = pointsMap(detail::thinned(all, kSubmapSpacing));
}

}  // namespace csom
