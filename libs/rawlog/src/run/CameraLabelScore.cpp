// SPDX-License-Identifier: BSD-3-Clause
// Labels points by camera images of a simulated world, and compares them with the truth.
#include <csom/core/Error.h>
#include <csom/maps/CameraImage.h>
#include <csom/maps/PointExtractor.h>
#include <csom/rawlog/CameraLabelScore.h>
#include <csom/rawlog/RawlogReader.h>
#include <csom/rawlog/Simulation.h>
#include <csom/vision/SemanticImage.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "poses/EigenPose.h"

namespace csom {
namespace {

using detail::toEigen;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using mrpt::obs::CObservationImage;
using mrpt::obs::CObservationRobotPose;
using mrpt::obs::CObservationVelodyneScan;

/// Noise of the range lets a point lie this much behind its own surface [m].
constexpr double kSurfaceTolerance = 0.1;

/// Labels of the sensors that can be scored.
struct Sensors {
  std::set<std::string> lidars;
  std::set<std::string> label_images;

  explicit Sensors(const Scenario& scenario) {
    for (const SensorModel& sensor : scenario.sensors) {
      if (const auto* velodyne = std::get_if<VelodyneModel>(&sensor)) {
        if (velodyne->intensity == VelodyneModel::Intensity::Class &&
            velodyne->sweep == VelodyneModel::Sweep::Instantaneous)
          lidars.insert(velodyne->mount.label);
      } else if (const auto* camera = std::get_if<CameraModel>(&sensor)) {
        label_images.insert(camera->mount.label + "_labels");
      }
    }
    if (lidars.empty())
      throw ConfigError(scenario.file +
                        ": has no sensor of type velodyne_vlp16 with 'intensity: class' and "
                        "'sweep: instantaneous', whose points could be scored");
    if (label_images.empty())
      throw ConfigError(scenario.file +
                        ": has no sensor of type camera, whose labels could be scored");
  }
};

/// A class-id image as a camera that points are projected into.
class LabelCamera {
 public:
  /// `image`: of class ids.
  LabelCamera(const CameraImage& image, const LabelSet& labels)
      : projection_(image.calibration),
        image_(image.pixels,
               [&labels](std::uint32_t raw) {
                 const LabelSet::Raw found = labels.classOfRaw(raw);
                 return found.kind == LabelSet::RawKind::Class ? found.id : kUnknownPixel;
               }),
        pose_(toEigen(image.pose_on_robot)) {}

  /// On the robot.
  const Isometry3d& pose() const { return pose_; }
  const CameraProjection& projection() const { return projection_; }
  CameraView view(const Isometry3d& robot_from_points) const {
    return {&projection_, pose_.inverse() * robot_from_points, &image_};
  }

 private:
  CameraProjection projection_;
  LabelImage image_;
  Isometry3d pose_;
};

/// What was seen at one time.
struct Moment {
  std::optional<Isometry3d> robot;
  std::vector<std::unique_ptr<LabelCamera>> cameras;
  std::vector<std::shared_ptr<CObservationVelodyneScan>> scans;
};

/// What was made of a point, and what the naive projection makes of it.
CameraLabelTally computeTally(ClassId truth, bool visible, PointFate fate, ClassId class_id,
                              PointFate naive_fate, ClassId naive_class) {
  const bool labelled = fate == PointFate::Labelled;
  const bool naive_labelled = naive_fate == PointFate::Labelled;
  const bool rejected = fate == PointFate::Hidden || fate == PointFate::AtEdge;
  CameraLabelTally tally;
  tally.in_view = 1;
  tally.fates[static_cast<std::size_t>(fate)] = 1;
  if (visible) {
    tally.visible = 1;
    tally.visible_fates = tally.fates;
  }
  tally.correct = labelled && class_id == truth ? 1 : 0;
  tally.naive_labelled = naive_labelled ? 1 : 0;
  tally.naive_correct = naive_labelled && naive_class == truth ? 1 : 0;
  tally.lost = visible && rejected && naive_labelled ? 1 : 0;
  return tally;
}

class Scorer {
 public:
  Scorer(const Scenario& scenario, const std::string& rawlog, const PointLabellingOptions& options)
      : world_(scenario.world),
        rawlog_(rawlog),
        sensors_(scenario),
        rules_(scenario.world.labels(), PointLabels::ByIntensity, "drop", "drop"),
        options_(options) {
    naive_.visibility = false;
    naive_.edge_margin = 0;
    score_.by_class.resize(static_cast<std::size_t>(scenario.world.labels().numberOfClasses()));
  }

  void add(const mrpt::obs::CObservation::Ptr& observation);
  CameraLabelScore finish();

 private:
  std::unique_ptr<LabelCamera> cameraOf(const CObservationImage& image) const;
  void scoreMoment();
  void scoreScan(const CObservationVelodyneScan& scan);
  bool isVisible(const Vector3d& point) const;

  const World& world_;
  std::string rawlog_;
  Sensors sensors_;
  LabelRules rules_;
  PointLabellingOptions options_;
  PointLabellingOptions naive_;
  mrpt::Clock::time_point time_{};
  Moment moment_;
  CameraLabelScore score_;
};

void Scorer::add(const mrpt::obs::CObservation::Ptr& observation) {
  if (observation->timestamp != time_) {
    scoreMoment();
    time_ = observation->timestamp;
  }
  if (const auto pose = std::dynamic_pointer_cast<CObservationRobotPose>(observation)) {
    if (pose->sensorLabel == kTruthPoseLabel) moment_.robot = toEigen(pose->pose.mean);
  } else if (const auto image = std::dynamic_pointer_cast<CObservationImage>(observation)) {
    if (sensors_.label_images.count(image->sensorLabel) > 0)
      moment_.cameras.push_back(cameraOf(*image));
  } else if (auto scan = std::dynamic_pointer_cast<CObservationVelodyneScan>(observation)) {
    if (sensors_.lidars.count(scan->sensorLabel) > 0) moment_.scans.push_back(std::move(scan));
  }
}

std::unique_ptr<LabelCamera> Scorer::cameraOf(const CObservationImage& image) const {
  try {
    return std::make_unique<LabelCamera>(*toCameraImage(image), world_.labels());
  } catch (const std::exception& error) {
    throw FileError(rawlog_, "image of '" + image.sensorLabel + "': " + error.what());
  }
}

void Scorer::scoreMoment() {
  const bool complete = moment_.robot && !moment_.cameras.empty();
  (complete ? score_.scans : score_.scans_without_image) += moment_.scans.size();
  if (complete) {
    for (const auto& scan : moment_.scans) scoreScan(*scan);
  }
  moment_ = {};
}

CameraLabelScore Scorer::finish() {
  scoreMoment();
  if (score_.scans == 0)
    throw FileError(rawlog_, "has no scan of '" + *sensors_.lidars.begin() +
                                 "' with an image of '" + *sensors_.label_images.begin() +
                                 "' and a pose '" + kTruthPoseLabel +
                                 "' of the same time: simulate it from this world");
  return std::move(score_);
}

/// True if a camera in whose image the point (in the world) lies has a free line of sight to it.
bool Scorer::isVisible(const Vector3d& point) const {
  return std::any_of(moment_.cameras.begin(), moment_.cameras.end(), [&](const auto& camera) {
    const Isometry3d pose = *moment_.robot * camera->pose();
    const auto pixel = camera->projection().project(pose.inverse() * point);
    if (!pixel || !camera->projection().contains(*pixel)) return false;
    const Vector3d ray = point - pose.translation();
    const double distance = ray.norm();
    return !world_.castRay(pose.translation(), ray / distance, distance - kSurfaceTolerance);
  });
}

void Scorer::scoreScan(const CObservationVelodyneScan& scan) {
  const SensorPoints sensed = findPointExtractor(scan)->extract(scan, rules_);
  const Isometry3d sensor = toEigen(sensed.sensor_pose);
  std::vector<CameraView> views;
  for (const auto& camera : moment_.cameras) views.push_back(camera->view(sensor));
  const int classes = world_.labels().numberOfClasses();
  const LabelledPoints labelled = labelPoints(sensed.points, views, classes, options_);
  const LabelledPoints naive = labelPoints(sensed.points, views, classes, naive_);
  for (std::size_t i = 0; i < sensed.points.size(); ++i) {
    const PointLabel& truth = sensed.labels[i];
    if (truth.kind != PointLabel::Kind::Class || truth.id == kFreeClass)
      throw FileError(rawlog_, "is no simulation of this world: a point of '" + scan.sensorLabel +
                                   "' has no class of label set '" + world_.labels().name() + "'");
    if (naive.fates[i] == PointFate::OutsideView) continue;
    const bool visible = isVisible(*moment_.robot * sensor * sensed.points[i].cast<double>());
    const CameraLabelTally tally =
        computeTally(truth.id, visible, labelled.fates[i], labelled.classes[i], naive.fates[i],
                     naive.classes[i]);
    score_.by_class[truth.id] += tally;
    score_.all += tally;
  }
}

double share(std::size_t part, std::size_t whole, double of_nothing) {
  return whole == 0 ? of_nothing : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

CameraLabelTally& CameraLabelTally::operator+=(const CameraLabelTally& other) {
  in_view += other.in_view;
  visible += other.visible;
  for (std::size_t i = 0; i < kPointFates; ++i) {
    fates[i] += other.fates[i];
    visible_fates[i] += other.visible_fates[i];
  }
  correct += other.correct;
  naive_labelled += other.naive_labelled;
  naive_correct += other.naive_correct;
  lost += other.lost;
  return *this;
}

double CameraLabelTally::correctShare() const {
  return share(correct, labelled(), 1);
}

double CameraLabelTally::naiveCorrectShare() const {
  return share(naive_correct, naive_labelled, 1);
}

double CameraLabelTally::lostShare() const {
  return share(lost, visible, 0);
}

CameraLabelScore scoreCameraLabels(const Scenario& scenario, const std::string& rawlog,
                                   const PointLabellingOptions& options) {
  if (!scenario.world.movingSolids().empty())
    throw ConfigError(scenario.file +
                      ": solids move in this world, so that it has no true class of a place; take "
                      "one without 'moves'");
  Scorer scorer(scenario, rawlog, options);
  RawlogReader reader(rawlog);
  while (const auto entry = reader.next()) {
    for (const auto& observation : entry->observations) scorer.add(observation);
  }
  if (!reader.end().complete) throw FileError(rawlog, reader.end().reason);
  return scorer.finish();
}

}  // namespace csom
