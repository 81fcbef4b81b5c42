// SPDX-License-Identifier: BSD-3-Clause
// The poses of a log that come from registering its scans.
#include "poses/RegisteredScans.h"

#include <csom/maps/PointExtractor.h>
#include <csom/rawlog/Deskew.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <chrono>
#include <cstdio>

#include "logs/MrptText.h"
#include "logs/ObservationKind.h"
#include "poses/EigenPose.h"

namespace csom::detail {
namespace {

/// Further ones would only fill the terminal; all are counted.
constexpr std::size_t kDoubtsKept = 5;

/// Points of a scan in the frame of the robot; none if they cannot be read.
std::vector<Eigen::Vector3f> pointsOnRobot(const mrpt::obs::CObservation& scan) {
  const LabelSet labels = LabelSet::occupancy();
  const LabelRules no_labels(labels, PointLabels::None, "", "");
  SensorPoints sensed;
  try {
    sensed = findPointExtractor(scan)->extract(scan, no_labels);
  } catch (const std::exception&) {
    return {};
  }
  const Eigen::Isometry3d on_robot = toEigen(sensed.sensor_pose);
  for (Eigen::Vector3f& point : sensed.points)
    point = (on_robot * point.cast<double>()).cast<float>();
  return std::move(sensed.points);
}

/// Points of a scan as if all had been seen at once, if the robot moves as `before` expects.
std::vector<Eigen::Vector3f> pointsWithoutMotion(const mrpt::obs::CObservation& observation,
                                                 double time, const ScanRegistration& before) {
  const auto* scan = dynamic_cast<const mrpt::obs::CObservationVelodyneScan*>(&observation);
  if (scan == nullptr) return pointsOnRobot(observation);
  DeskewStatistics not_of_interest;
  const auto moved = deskewed(
      *scan,
      [&](double at) -> std::optional<mrpt::poses::CPose3D> {
        return before.predictedMotion(at - time);
      },
      not_of_interest);
  return pointsOnRobot(moved ? *moved : observation);
}

}  // namespace

void RegisteredScans::add(const mrpt::obs::CObservation& observation, PoseTrack& track) {
  if (observation.sensorLabel != sensor_label_ || !isScan3D(observation)) return;
  const auto time = secondsOf(observation.timestamp);
  if (!time) return;
  const auto start = std::chrono::steady_clock::now();
  // The motion of the turn at hand is not known yet: it is taken to go on as before.
  const bool second = first_ && *time > *last_time_;
  const std::vector<Eigen::Vector3f> points =
      second ? secondPoints(observation, *time)
             : pointsWithoutMotion(observation, *time, registration_);
  if (points.empty()) return;
  if (report_.statistics.scans++ == 0 && sweepEnd(observation))
    first_ = std::dynamic_pointer_cast<const mrpt::obs::CObservation>(
        observation.duplicateGetSmartPtr());
  if (last_time_ && *time <= *last_time_) {
    noteDoubt(*time, "it is not later than the scan before, so it is not registered at all");
    return;
  }
  last_time_ = time;
  const ScanRegistration::Result result = registration_.add(*time, points);
  track.add(*time, result.pose);
  if (!result.doubt.empty()) noteDoubt(*time, result.doubt);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  report_.statistics.seconds += elapsed.count();
}

/// The motion during the first turn is known from the second one: with it, both are as they should
/// be. Else the first key frames, on which all later scans are laid, would be crooked.
std::vector<Eigen::Vector3f> RegisteredScans::secondPoints(const mrpt::obs::CObservation& second,
                                                           double time) {
  const std::vector<Eigen::Vector3f> as_they_are = pointsOnRobot(second);
  if (as_they_are.empty()) return {};
  ScanRegistration trial = registration_;
  trial.add(time, as_they_are);
  registration_ = ScanRegistration();
  registration_.add(*last_time_, pointsWithoutMotion(*first_, *last_time_, trial));
  first_.reset();
  return pointsWithoutMotion(second, time, trial);
}

void RegisteredScans::noteDoubt(double time, const std::string& doubt) {
  if (report_.statistics.doubtful++ >= kDoubtsKept) return;
  char place[96];
  std::snprintf(place, sizeof place,
                "registration of scan %zu at t=%.3f s is doubtful: ", report_.statistics.scans - 1,
                time);
  report_.doubts.push_back(place + doubt);
}

}  // namespace csom::detail
