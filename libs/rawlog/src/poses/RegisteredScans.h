// SPDX-License-Identifier: BSD-3-Clause
// The poses of a log that come from registering its scans.
#pragma once

#include <csom/rawlog/PoseTrack.h>
#include <csom/rawlog/ScanRegistration.h>
#include <mrpt/obs/CObservation.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace csom::detail {

/// Registers the 3-D scans of one sensor.
class RegisteredScans {
 public:
  explicit RegisteredScans(const std::string& sensor_label) : sensor_label_(sensor_label) {}

  /// To be called with every observation of the log, in order. Those that are no scan of the
  /// sensor are passed over; scans without a time stamp or without readable points too, as the map
  /// will refuse them.
  void add(const mrpt::obs::CObservation& observation, PoseTrack& track);

  const RegistrationReport& report() const { return report_; }

 private:
  using Scan = std::shared_ptr<const mrpt::obs::CObservation>;

  std::vector<Eigen::Vector3f> secondPoints(const mrpt::obs::CObservation& second, double time);
  void noteDoubt(double time, const std::string& doubt);

  std::string sensor_label_;
  ScanRegistration registration_;
  RegistrationReport report_;
  std::optional<double> last_time_;
  Scan first_;  ///< until there is a second one, if the sensor moves while it scans
};

}  // namespace csom::detail
