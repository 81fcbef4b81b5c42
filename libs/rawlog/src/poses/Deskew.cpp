// SPDX-License-Identifier: BSD-3-Clause
// A LiDAR that is carried along while it turns sees each direction from another place.
#include <csom/maps/VelodynePackets.h>
#include <csom/rawlog/Deskew.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <vector>

#include "logs/MrptText.h"
#include "poses/EigenPose.h"

namespace csom {
namespace {

using mrpt::obs::CObservationVelodyneScan;

/// The times of a scan's packets.
struct Sweep {
  double start = 0;          ///< [s since 1970]
  double last_packet = 0;    ///< [s] from the start
  double packet_length = 0;  ///< [s]
  double end() const { return start + last_packet + packet_length; }
};

/// Nothing if there is no time stamp, or no packet.
std::optional<Sweep> findSweep(const CObservationVelodyneScan& scan) {
  const auto start = detail::secondsOf(scan.timestamp);
  if (!start || scan.scan_packets.empty()) return std::nullopt;
  Sweep sweep;
  sweep.start = *start;
  for (std::size_t packet = 0; packet < scan.scan_packets.size(); ++packet)
    sweep.last_packet = std::max(sweep.last_packet, secondsSinceFirst(scan, packet));
  if (scan.scan_packets.size() > 1)
    sweep.packet_length = sweep.last_packet / static_cast<double>(scan.scan_packets.size() - 1);
  return sweep;
}

/// Moves points to where the sensor would have seen them at the start of the sweep.
class MovedPoints {
 public:
  MovedPoints(const CObservationVelodyneScan& scan, const Sweep& sweep, const RobotMotion& motion,
              MovedVelodyneScan& out)
      : sweep_(sweep),
        motion_(motion),
        mount_(detail::toEigen(scan.sensorPose)),
        rows_(rowsOfLasers(scan.calibration)),
        out_(out) {
    const auto start = sensorAt(sweep.start);
    complete_ = start && sensorAt(sweep.end());
    if (start) start_from_map_ = start->inverse();
  }

  /// False if there is a time at which it is not known where the robot was.
  bool complete() const { return complete_; }

  void add(const VelodyneBeam& beam) {
    // A robot does not move between the lasers of one firing.
    constexpr double kFiring = 30e-6;
    const double time = std::min(sweep_.start + beam.seconds, sweep_.end());
    if (!time_ || std::abs(time - *time_) > kFiring) {
      time_ = time;
      const auto sensor = sensorAt(time);
      complete_ = complete_ && sensor;
      if (sensor) start_from_beam_ = start_from_map_ * *sensor;
    }
    if (!beam.returned) {
      addEmpty(beam);
      return;
    }
    const Eigen::Vector3f moved = (start_from_beam_ * beam.point.cast<double>()).cast<float>();
    auto& cloud = out_.point_cloud;
    cloud.x.push_back(moved.x());
    cloud.y.push_back(moved.y());
    cloud.z.push_back(moved.z());
    cloud.intensity.push_back(beam.intensity);
    cloud.azimuth.push_back(0.01F * static_cast<float>(beam.azimuth));
    cloud.laser_id.push_back(beam.laser);
    farthest_ = std::max(farthest_, moved.norm());
  }
  /// Largest range of a point that was added [m].
  float farthest() const { return farthest_; }

 private:
  void addEmpty(const VelodyneBeam& beam) {
    if (beam.point.isZero()) {
      ++out_.too_near;
      return;
    }
    const Eigen::Vector3d farthest = out_.maxRange * beam.point.cast<double>();
    out_.empty_beams.push_back(
        {(start_from_beam_ * farthest).cast<float>(), {rows_[beam.laser], beam.azimuth}});
  }
  std::optional<Eigen::Isometry3d> sensorAt(double time) const {
    const auto robot = motion_(time);
    if (!robot) return std::nullopt;
    return detail::toEigen(*robot) * mount_;
  }

  const Sweep& sweep_;
  const RobotMotion& motion_;
  const Eigen::Isometry3d mount_;
  const std::vector<std::uint16_t> rows_;
  MovedVelodyneScan& out_;
  bool complete_ = false;
  float farthest_ = 0;
  Eigen::Isometry3d start_from_map_ = Eigen::Isometry3d::Identity();
  std::optional<double> time_;
  Eigen::Isometry3d start_from_beam_ = Eigen::Isometry3d::Identity();
};

}  // namespace

CObservationVelodyneScan::Ptr deskewed(const CObservationVelodyneScan& scan,
                                       const RobotMotion& motion, DeskewStatistics& statistics) {
  const auto sweep = findSweep(scan);
  if (!sweep) return nullptr;
  if (sweep->last_packet <= 0) {
    ++statistics.not_needed;
    return nullptr;
  }
  std::vector<VelodyneBeam> beams;
  try {
    beams = decodePackets(scan);
  } catch (const std::exception&) {
    return nullptr;
  }
  auto copy = std::make_shared<MovedVelodyneScan>();
  static_cast<CObservationVelodyneScan&>(*copy) = scan;
  copy->point_cloud.clear();
  MovedPoints points(scan, *sweep, motion, *copy);
  if (points.complete()) {
    copy->point_cloud.reserve(beams.size());
    for (const VelodyneBeam& beam : beams) points.add(beam);
  }
  if (!points.complete()) {
    ++statistics.not_possible;
    return nullptr;
  }
  ++statistics.deskewed;
  copy->scan_packets.clear();
  // What the sensor saw at its longest range may be a little farther from where it began its turn.
  copy->maxRange = std::max(copy->maxRange, static_cast<double>(points.farthest()));
  return copy;
}

std::optional<double> sweepEnd(const mrpt::obs::CObservation& observation) {
  const auto* scan = dynamic_cast<const CObservationVelodyneScan*>(&observation);
  if (scan == nullptr) return std::nullopt;
  const auto sweep = findSweep(*scan);
  if (!sweep || sweep->last_packet <= 0) return std::nullopt;
  return sweep->end();
}

}  // namespace csom
