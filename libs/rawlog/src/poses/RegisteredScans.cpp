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

}  // namespace

void RegisteredScans::add(const mrpt::obs::CObservation& observation, PoseTrack& track) {
  if (observation.sensorLabel != sensor_label_ || !isScan3D(observation)) return;
  const auto time = secondsOf(observation.timestamp);
  if (!time) return;
  const auto start = std::chrono::steady_clock::now();
  const std::vector<Eigen::Vector3f> points = pointsOnRobot(*withoutMotion(observation, *time));
  if (points.empty()) return;
  ++report_.statistics.scans;
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

/// The motion of the turn at hand is not known yet: it is taken to go on as before.
RegisteredScans::Scan RegisteredScans::withoutMotion(const mrpt::obs::CObservation& observation,
                                                     double time) const {
  const Scan as_it_is(Scan(), &observation);
  const auto* scan = dynamic_cast<const mrpt::obs::CObservationVelodyneScan*>(&observation);
  if (scan == nullptr || !last_time_) return as_it_is;
  DeskewStatistics not_of_interest;
  const auto moved = deskewed(
      *scan,
      [&](double at) -> std::optional<mrpt::poses::CPose3D> {
        return registration_.predictedMotion(at - time);
      },
      not_of_interest);
  if (!moved) return as_it_is;
  return moved;
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
