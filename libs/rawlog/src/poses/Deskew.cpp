// SPDX-License-Identifier: BSD-3-Clause
// A LiDAR that is carried along while it turns sees each direction from another place.
#include <csom/rawlog/Deskew.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>

#include "logs/MrptText.h"
#include "poses/EigenPose.h"

namespace csom {
namespace {

using mrpt::obs::CObservationVelodyneScan;

/// The times of a scan's packets.
struct Sweep {
  double start = 0;        ///< [s since 1970]
  double half_packet = 0;  ///< [s] from a packet's time to its middle
  double last_packet = 0;  ///< [s] from the start
  double end() const { return start + last_packet + half_packet; }
};

/// What packet.gps_timestamp() should return: that one binds a reference to a number that lies at
/// no multiple of four bytes.
std::uint32_t timeOf(const CObservationVelodyneScan::TVelodyneRawPacket& packet) {
  static_assert(sizeof packet == sizeof packet.blocks + sizeof(std::uint32_t) + 2);
  std::uint32_t time;
  std::memcpy(&time, reinterpret_cast<const std::uint8_t*>(&packet) + sizeof packet.blocks,
              sizeof time);
  return time;
}

/// Nothing if there is no time stamp, or no packet.
std::optional<Sweep> findSweep(const CObservationVelodyneScan& scan) {
  const auto start = detail::secondsOf(scan.timestamp);
  if (!start || scan.scan_packets.empty()) return std::nullopt;
  Sweep sweep;
  sweep.start = *start;
  const std::uint32_t first = timeOf(scan.scan_packets.front());
  for (const auto& packet : scan.scan_packets) {
    // Microseconds since the hour began, which may end during the turn.
    constexpr std::uint32_t kHour = 3'600'000'000;
    const std::uint32_t time = timeOf(packet);
    const std::uint32_t elapsed = time >= first ? time - first : kHour - first + time;
    sweep.last_packet = std::max(sweep.last_packet, 1e-6 * elapsed);
  }
  if (scan.scan_packets.size() > 1)
    sweep.half_packet =
        sweep.last_packet / (2.0 * static_cast<double>(scan.scan_packets.size() - 1));
  return sweep;
}

/// Moves points to where the sensor would have seen them at the start of the sweep.
class MovedPoints : public CObservationVelodyneScan::PointCloudStorageWrapper {
 public:
  MovedPoints(const CObservationVelodyneScan& scan, const Sweep& sweep, const RobotMotion& motion,
              CObservationVelodyneScan::TPointCloud& out)
      : sweep_(sweep), motion_(motion), mount_(detail::toEigen(scan.sensorPose)), out_(out) {
    const auto start = sensorAt(sweep.start);
    complete_ = start && sensorAt(sweep.end());
    if (start) start_from_map_ = start->inverse();
  }

  /// False if there is a time at which it is not known where the robot was.
  bool complete() const { return complete_; }

  void reserve(std::size_t count) override { out_.reserve(count); }
  void add_point(float x, float y, float z, std::uint8_t intensity,
                 const mrpt::system::TTimeStamp& time, float /*azimuth*/,
                 std::uint16_t /*laser*/) override {
    if (!packet_ || *packet_ != time) {
      packet_ = time;
      const auto sensor = sensorAt(mrpt::Clock::toDouble(time) + sweep_.half_packet);
      complete_ = complete_ && sensor;
      if (sensor) start_from_packet_ = start_from_map_ * *sensor;
    }
    const Eigen::Vector3f moved = (start_from_packet_ * Eigen::Vector3d(x, y, z)).cast<float>();
    out_.x.push_back(moved.x());
    out_.y.push_back(moved.y());
    out_.z.push_back(moved.z());
    out_.intensity.push_back(intensity);
    farthest_ = std::max(farthest_, moved.norm());
  }
  /// Largest range of a point that was added [m].
  float farthest() const { return farthest_; }

 private:
  std::optional<Eigen::Isometry3d> sensorAt(double time) const {
    const auto robot = motion_(time);
    if (!robot) return std::nullopt;
    return detail::toEigen(*robot) * mount_;
  }

  const Sweep& sweep_;
  const RobotMotion& motion_;
  const Eigen::Isometry3d mount_;
  CObservationVelodyneScan::TPointCloud& out_;
  bool complete_ = false;
  float farthest_ = 0;
  Eigen::Isometry3d start_from_map_ = Eigen::Isometry3d::Identity();
  std::optional<mrpt::system::TTimeStamp> packet_;
  Eigen::Isometry3d start_from_packet_ = Eigen::Isometry3d::Identity();
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
  auto copy = std::make_shared<CObservationVelodyneScan>(scan);
  copy->point_cloud.clear();
  MovedPoints points(scan, *sweep, motion, copy->point_cloud);
  if (points.complete()) {
    CObservationVelodyneScan::TGeneratePointCloudParameters parameters;
    parameters.minDistance = 0;  // as the map reads packets
    try {
      copy->generatePointCloud(points, parameters);
    } catch (const std::exception&) {
      return nullptr;
    }
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
