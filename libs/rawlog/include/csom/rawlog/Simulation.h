// SPDX-License-Identifier: BSD-3-Clause
// A scenario becomes a rawlog.
#pragma once

#include <csom/eval/Scenario.h>

#include <cstddef>
#include <functional>
#include <string>

namespace csom {

/// How the entries of a rawlog are laid out.
enum class RawlogFormat {
  SensoryFrames,  ///< pairs of CActionCollection and CSensoryFrame: every MRPT application
  Observations,   ///< one CObservation after the other, odometry among them
};

/// The sensor label of the CObservationRobotPose with the robot's true pose.
constexpr const char* kTruthPoseLabel = "truth";

struct SimulationOptions {
  RawlogFormat format = RawlogFormat::SensoryFrames;
  std::string trajectory_file;  ///< true poses in TUM format; empty: not written
};

struct SimulationSummary {
  std::size_t frames = 0;        ///< moments at which at least one sensor works
  std::size_t observations = 0;  ///< of sensors, true poses and odometry not counted
  std::size_t returns = 0;       ///< labelled ranges, pixels not counted
  double duration = 0;           ///< [s]
  double length = 0;             ///< [m]
};

/// Called after each frame with the number done and of all.
using SimulationProgress = std::function<void(std::size_t done, std::size_t total)>;

/// Drives through `scenario` and writes what the sensors saw to `rawlog_file` (gz-compressed; first
/// to a file beside it, which then takes its place). The same scenario gives the same bytes. Throws
/// FileError if a file cannot be written, ConfigError if a sensor is inside a solid.
SimulationSummary simulateRawlog(const Scenario& scenario, const std::string& rawlog_file,
                                 const SimulationOptions& options = {},
                                 const SimulationProgress& progress = {});

}  // namespace csom
