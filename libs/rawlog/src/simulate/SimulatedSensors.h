// SPDX-License-Identifier: BSD-3-Clause
// What each kind of simulated sensor sees of a world from one place.
#pragma once

#include <csom/eval/Random.h>
#include <csom/eval/Scenario.h>
#include <mrpt/core/Clock.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <vector>

namespace csom::detail {

/// A moment of the simulation: the robot's path, and how far along it is.
struct Moment {
  const RobotPath& path;
  double time;                        ///< seconds since the start
  mrpt::Clock::time_point timestamp;  ///< the same moment, as rawlogs give it

  /// The robot `delay` seconds later.
  Eigen::Isometry3d robot(double delay = 0) const;
};

struct Sensed {
  std::vector<mrpt::obs::CObservation::Ptr> observations;
  std::size_t returns = 0;  ///< ranges with a label
};

Sensed sense(const VelodyneModel& model, const World& world, const Moment& moment, Random& random);
Sensed sense(const CameraModel& model, const World& world, const Moment& moment, Random& random);
/// Throws ConfigError if it cannot see as many points as it should.
Sensed sense(const PointSamplerModel& model, const World& world, const Moment& moment,
             Random& random);

mrpt::poses::CPose3D toMrpt(const SensorMount& mount);

}  // namespace csom::detail
