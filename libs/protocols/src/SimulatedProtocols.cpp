// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/eval/GroundTruth.h>
#include <csom/io/TemporaryFolder.h>
#include <csom/protocols/LoggedScans.h>
#include <csom/protocols/Sight.h>
#include <csom/protocols/SimulatedProtocols.h>
#include <csom/rawlog/Simulation.h>

#include <stdexcept>
#include <utility>

namespace csom {
namespace {

/// The step of free points along a beam, as in the paper's experiments [m].
constexpr double kFreeResolution = 0.5;

std::shared_ptr<const VoxelTruth> computeTruth(const Scenario& scenario) {
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
  trial.options.free_space.mode = FreeSpace::Sampled;
  trial.options.free_space.resolution = kFreeResolution;
  trial.truth = computeTruth(scenario);
  return trial;
}

std::shared_ptr<const std::vector<Scan>> scansOf(const std::string& rawlog,
                                                 const Scenario& scenario,
                                                 const LogReading& reading) {
  return std::make_shared<std::vector<Scan>>(
      readLoggedScans(rawlog, scenario.world.labels(), reading));
}

/// Odometry knows no other start than the origin: the scans as if it had begun where the robot did.
std::shared_ptr<const std::vector<Scan>> movedToStart(const std::vector<Scan>& scans,
                                                      const Scenario& scenario) {
  const Eigen::Isometry3d start = scenario.path.at(0).isometry();
  auto moved = std::make_shared<std::vector<Scan>>(scans);
  for (Scan& scan : *moved) {
    scan.origin = start * scan.origin;
    for (Eigen::Vector3f& point : scan.points)
      point = (start.linear() * point.cast<double>()).cast<float>();
  }
  return moved;
}

/// Without the voxels that no beam crosses or ends in.
std::shared_ptr<const VoxelTruth> seenOf(const Trial& trial, const std::vector<Scan>& scans) {
  Options options;
  options.number_of_classes = trial.options.number_of_classes;
  options.resolution = trial.options.resolution;
  options.method = Method::SCsm;
  options.free_space.mode = FreeSpace::Raycast;
  SemanticMap beams(options);
  for (const Scan& scan : scans) beams.insert(scan);
  auto seen = std::make_shared<VoxelTruth>(*trial.truth);
  seen->keepOnly(beams);
  return seen;
}

LabelOptions camerasOf(const Scenario& scenario) {
  LabelOptions options;
  // What the cameras label is asked for; all methods get the same points.
  options.outside_view = OutsideView::Drop;
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

/// A trial whose sensors label their points themselves, with true poses.
Trial selfLabelledTrial(const std::string& protocol, const Scenario& scenario) {
  const TemporaryFolder folder;
  const std::string rawlog = folder.file("drive.rawlog");
  simulateRawlog(scenario, rawlog);
  Trial trial = simulatedTrial(protocol, scenario);
  LogReading reading;
  reading.point_labels = PointLabels::ByIntensity;
  reading.poses = {PoseChoice::Kind::RobotPose, kTruthPoseLabel};
  trial.scans = scansOf(rawlog, scenario, reading);
  return trial;
}

}  // namespace

std::vector<Trial> structuredRoomTrials(const Scenario& scenario) {
  return {selfLabelledTrial("P4", scenario)};
}

std::vector<Trial> movingTrials(const Scenario& scenario) {
  if (scenario.world.movingSolids().empty())
    throw ConfigError(scenario.file + ": nothing moves; give a solid `moves`");
  Trial trial = selfLabelledTrial("P8", scenario);
  trial.options.free_space.mode = FreeSpace::Raycast;
  trial.options.scan.ds_resolution = trial.options.resolution;
  trial.sight = std::make_shared<std::vector<SightCheck>>(
      planSightChecks(scenario, *trial.scans, trial.options.resolution));
  return {trial};
}

std::vector<Trial> robotTrials(const Scenario& scenario) {
  LogReading reading;
  reading.point_labels = PointLabels::None;
  reading.label_options = camerasOf(scenario);
  const TemporaryFolder folder;
  const std::string rawlog = folder.file("drive.rawlog");
  simulateRawlog(scenario, rawlog);
  const Trial trial = simulatedTrial("P5", scenario);

  Trial with_true_poses = trial;
  with_true_poses.variant = "true poses";
  reading.poses = {PoseChoice::Kind::RobotPose, kTruthPoseLabel};
  with_true_poses.scans = scansOf(rawlog, scenario, reading);
  with_true_poses.seen_truth = seenOf(trial, *with_true_poses.scans);

  Trial with_odometry = trial;
  with_odometry.variant = "odometry";
  reading.poses = {PoseChoice::Kind::Odometry, ""};
  with_odometry.scans = movedToStart(*scansOf(rawlog, scenario, reading), scenario);
  with_odometry.seen_truth = with_true_poses.seen_truth;
  return {with_true_poses, with_odometry};
}

}  // namespace csom
