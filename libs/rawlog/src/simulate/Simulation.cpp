// SPDX-License-Identifier: BSD-3-Clause
// Drives a robot through a scenario and records what its sensors see.
#include <csom/core/Error.h>
#include <csom/io/OutputFile.h>
#include <csom/rawlog/RawlogWriter.h>
#include <csom/rawlog/Simulation.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <vector>

#include "simulate/SimulatedOdometry.h"
#include "simulate/SimulatedSensors.h"

namespace csom {
namespace detail {

mrpt::poses::CPose3D toMrpt(const SensorMount& mount) {
  return {mount.position.x(), mount.position.y(), mount.position.z(),
          mount.yaw,          mount.pitch,        mount.roll};
}

Eigen::Isometry3d Moment::robot(double delay) const {
  return path.at(time + delay).isometry();
}

}  // namespace detail

namespace {

using detail::Moment;
using detail::Sensed;
using Microseconds = std::chrono::microseconds;

/// Every simulation begins at 2020-01-01 00:00:00 UTC, so that equal worlds give equal files.
constexpr double kStartTime = 1577836800.0;

/// zlib's best: simulated rawlogs are small and kept.
constexpr int kCompression = 9;

constexpr std::uint64_t kOdometryStream = 0;  // of random numbers; sensor i has stream i + 1

/// Which sensors work at which time. Sensor with rate f works at 0, 1/f, 2/f … before the end.
using Schedule = std::map<Microseconds, std::vector<std::size_t>>;

Schedule makeSchedule(const Scenario& scenario) {
  Schedule schedule;
  for (std::size_t i = 0; i < scenario.sensors.size(); ++i) {
    const double rate = mountOf(scenario.sensors[i]).rate;
    for (long k = 0;; ++k) {
      const Microseconds time(std::llround(static_cast<double>(k) / rate * 1e6));
      if (static_cast<double>(time.count()) * 1e-6 >= scenario.path.duration()) break;
      schedule[time].push_back(i);
    }
  }
  return schedule;
}

/// True poses as lines of the TUM format, held until they are all there.
class Trajectory {
 public:
  void add(const Moment& moment) {
    const PlanarPose pose = moment.path.at(moment.time);
    char line[160];
    std::snprintf(line, sizeof line, "%.6f %.6f %.6f 0 0 0 %.9f %.9f\n", kStartTime + moment.time,
                  pose.x, pose.y, std::sin(pose.yaw / 2), std::cos(pose.yaw / 2));
    text_ += line;
  }

  void save(const std::string& file) const {
    OutputFile output(file);
    output.write("# timestamp x y z qx qy qz qw\n");
    output.write(text_);
    output.commit();
  }

 private:
  std::string text_;
};

mrpt::obs::CObservation::Ptr truePose(const Moment& moment) {
  const PlanarPose pose = moment.path.at(moment.time);
  auto observation = mrpt::obs::CObservationRobotPose::Create();
  observation->sensorLabel = kTruthPoseLabel;
  observation->timestamp = moment.timestamp;
  observation->pose.mean = mrpt::poses::CPose3D(pose.x, pose.y, 0, pose.yaw, 0, 0);
  observation->pose.cov.setZero();
  return observation;
}

class Simulation {
 public:
  Simulation(const Scenario& scenario, RawlogFormat format, RawlogWriter& rawlog)
      : scenario_(scenario),
        format_(format),
        rawlog_(rawlog),
        odometry_(scenario.odometry, scenario.path.at(0), Random(scenario.seed, kOdometryStream)) {
    for (std::size_t i = 0; i < scenario.sensors.size(); ++i)
      random_.emplace_back(scenario.seed, i + 1);
  }

  /// What the sensors see at a moment, which is also written.
  Sensed record(const Moment& moment, const std::vector<std::size_t>& sensors) {
    Sensed all;
    for (const std::size_t i : sensors) {
      const Sensed sensed = observe(i, moment);
      all.observations.insert(all.observations.end(), sensed.observations.begin(),
                              sensed.observations.end());
      all.returns += sensed.returns;
    }
    const auto increment = odometry_.move(moment.path.at(moment.time));
    if (format_ == RawlogFormat::SensoryFrames) {
      writeFrame(moment, increment, all);
    } else {
      writeObservations(moment, all);
    }
    return all;
  }

 private:
  Sensed observe(std::size_t sensor, const Moment& moment);
  void writeFrame(const Moment& moment, const mrpt::poses::CPose2D& increment,
                  const Sensed& sensed);
  void writeObservations(const Moment& moment, const Sensed& sensed);

  const Scenario& scenario_;
  RawlogFormat format_;
  RawlogWriter& rawlog_;
  detail::SimulatedOdometry odometry_;
  std::vector<Random> random_;
};

Sensed Simulation::observe(std::size_t sensor, const Moment& moment) {
  const SensorModel& model = scenario_.sensors[sensor];
  const SensorMount& mount = mountOf(model);
  const World& world = scenario_.world;
  const Eigen::Vector3d place = (moment.robot() * mount.pose()).translation();
  const auto inside = world.solidAt(place);
  if (inside)
    throw ConfigError(
        scenario_.file + ": sensor '" + mount.label + "' is inside solid " +
        std::to_string(*inside + 1) + " (" + world.labels().at(world.classAt(place)).name + ") " +
        std::to_string(moment.time) + " s after the start; move the robot's path or the solid");
  return std::visit([&](const auto& m) { return detail::sense(m, world, moment, random_[sensor]); },
                    model);
}

void Simulation::writeFrame(const Moment& moment, const mrpt::poses::CPose2D& increment,
                            const Sensed& sensed) {
  mrpt::obs::CActionRobotMovement2D movement;
  movement.timestamp = moment.timestamp;
  movement.computeFromOdometry(increment, odometry_.motionModel());
  mrpt::obs::CActionCollection actions;
  actions.insert(movement);
  rawlog_.write(actions);

  mrpt::obs::CSensoryFrame frame;
  frame.insert(truePose(moment));
  for (const auto& observation : sensed.observations) frame.insert(observation);
  rawlog_.write(frame);
}

void Simulation::writeObservations(const Moment& moment, const Sensed& sensed) {
  mrpt::obs::CObservationOdometry odometry;
  odometry.sensorLabel = "odometry";
  odometry.timestamp = moment.timestamp;
  odometry.odometry = odometry_.reading();
  rawlog_.write(odometry);
  rawlog_.write(*truePose(moment));
  for (const auto& observation : sensed.observations) rawlog_.write(*observation);
}

}  // namespace

SimulationSummary simulateRawlog(const Scenario& scenario, const std::string& rawlog_file,
                                 const SimulationOptions& options,
                                 const SimulationProgress& progress) {
  RawlogWriter rawlog(rawlog_file, kCompression);
  Simulation simulation(scenario, options.format, rawlog);
  Trajectory trajectory;
  SimulationSummary summary;
  summary.duration = scenario.path.duration();
  summary.length = scenario.path.length();
  const mrpt::Clock::time_point start = mrpt::Clock::fromDouble(kStartTime);
  const Schedule schedule = makeSchedule(scenario);
  for (const auto& [time, sensors] : schedule) {
    const Moment moment{scenario.path, static_cast<double>(time.count()) * 1e-6, start + time};
    const Sensed sensed = simulation.record(moment, sensors);
    trajectory.add(moment);
    ++summary.frames;
    summary.observations += sensed.observations.size();
    summary.returns += sensed.returns;
    if (progress) progress(summary.frames, schedule.size());
  }
  rawlog.commit();
  if (!options.trajectory_file.empty()) trajectory.save(options.trajectory_file);
  return summary;
}

}  // namespace csom
