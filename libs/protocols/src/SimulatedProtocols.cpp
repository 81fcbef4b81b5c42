// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/eval/GroundTruth.h>
#include <csom/protocols/LoggedScans.h>
#include <csom/protocols/SimulatedProtocols.h>
#include <csom/rawlog/Simulation.h>

#include <stdexcept>
#include <utility>

#include "TemporaryFolder.h"

namespace csom {
namespace {

/// The step of free points along a beam, as in the paper's experiments [m].
constexpr double kFreeResolution = 0.5;

std::shared_ptr<const VoxelTruth> truthOf(const Scenario& scenario) {
  try {
    const GroundTruth truth(scenario.world, scenario.truth.resolution);
    return std::make_shared<VoxelTruth>(truth.toMap(truth.voxelsIn(scenario.truth.region)));
  } catch (const std::invalid_argument& error) {
    throw ConfigError(scenario.file + ": truth: " + error.what());
  }
}

Trial simulatedTrial(const std::string& protocol, const Scenario& scenario) {
  Trial trial;
  trial.protocol = protocol;
  trial.labels = scenario.world.labels();
  trial.options.number_of_classes = trial.labels.numberOfClasses();
  trial.options.resolution = scenario.truth.resolution;
  trial.options.free_space = FreeSpace::Sampled;
  trial.options.free_resolution = kFreeResolution;
  trial.truth = truthOf(scenario);
  return trial;
}

std::shared_ptr<const std::vector<Scan>> scansOf(const std::string& rawlog,
                                                 const Scenario& scenario,
                                                 const LogReading& reading) {
  return std::make_shared<std::vector<Scan>>(
      readLoggedScans(rawlog, scenario.world.labels(), reading));
}

LabelOptions camerasOf(const Scenario& scenario) {
  LabelOptions options;
  for (const SensorModel& sensor : scenario.sensors) {
    if (!std::holds_alternative<CameraModel>(sensor)) continue;
    const std::string& label = mountOf(sensor).label;
    LabelSource source;
    source.sensor_label = label;
    source.kind = LabelSource::Kind::LabelImage;
    source.label_image = label + "_labels";
    options.sources.push_back(source);
  }
  if (options.sources.empty())
    throw ConfigError(scenario.file + ": has no camera, without which no point has a label");
  return options;
}

}  // namespace

std::vector<Trial> structuredRoomTrials(const Scenario& scenario) {
  const detail::TemporaryFolder folder;
  const std::string rawlog = folder.file("room.rawlog");
  simulateRawlog(scenario, rawlog);
  Trial trial = simulatedTrial("P4", scenario);
  LogReading reading;
  reading.point_labels = PointLabels::ByIntensity;
  reading.poses = {PoseChoice::Kind::RobotPose, kTruthPoseLabel};
  trial.scans = scansOf(rawlog, scenario, reading);
  return {trial};
}

std::vector<Trial> robotTrials(const Scenario& scenario) {
  LogReading reading;
  reading.point_labels = PointLabels::None;
  reading.label_options = camerasOf(scenario);
  const detail::TemporaryFolder folder;
  const std::string rawlog = folder.file("drive.rawlog");
  simulateRawlog(scenario, rawlog);
  const Trial trial = simulatedTrial("P5", scenario);
  const std::vector<std::pair<std::string, PoseChoice>> variants{
      {"true poses", {PoseChoice::Kind::RobotPose, kTruthPoseLabel}},
      {"odometry", {PoseChoice::Kind::Odometry, ""}}};
  std::vector<Trial> trials;
  for (const auto& [variant, poses] : variants) {
    reading.poses = poses;
    trials.push_back(trial);
    trials.back().variant = variant;
    trials.back().scans = scansOf(rawlog, scenario, reading);
  }
  return trials;
}

}  // namespace csom
