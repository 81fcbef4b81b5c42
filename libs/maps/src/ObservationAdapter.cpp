// SPDX-License-Identifier: BSD-3-Clause
// From observations to semantic points.
#include <csom/core/FindRangeImage.h>
#include <csom/maps/ObservationAdapter.h>
#include <csom/maps/PoseRounding.h>

#include "ImageOfKept.h"
#include "ObservationName.h"

namespace csom {
namespace {

void count(LabelCounts& counts, PointLabel::Kind kind) {
  switch (kind) {
    case PointLabel::Kind::Class:
      ++counts.labelled;
      break;
    case PointLabel::Kind::Missing:
      ++counts.missing;
      break;
    case PointLabel::Kind::Unknown:
      ++counts.unknown;
      break;
    case PointLabel::Kind::Ignored:
      ++counts.ignored;
      break;
    case PointLabel::Kind::Ambiguous:
      ++counts.ambiguous;
      break;
  }
}

/// The class that a point enters the map with; nothing if it is dropped.
std::optional<ClassId> classOf(const PointLabel& label, const LabelRules& rules,
                               LabelCounts& counts) {
  const bool is_class = label.kind == PointLabel::Kind::Class;
  if (is_class || label.kind == PointLabel::Kind::Ignored || !rules.unlabelledClass()) {
    count(counts, label.kind);
    return is_class ? std::make_optional(label.id) : std::nullopt;
  }
  ++(label.kind == PointLabel::Kind::Missing ? counts.unlabelled : counts.kept_unknown);
  return rules.unlabelledClass();
}

/// In the order of all beams that the observation lists.
std::optional<RangeImage> findImage(const SensorPoints& points) {
  if (points.no_returns == 0) return findRangeImage(points.points);
  const std::size_t count = points.points.size();
  std::vector<Eigen::Vector3f> beams(count + points.no_returns, Eigen::Vector3f(0, 0, 0));
  for (std::size_t i = 0; i < count; ++i) beams[i + points.no_returns_before[i]] = points.points[i];
  std::optional<RangeImage> image = findRangeImage(beams);
  if (!image) return image;
  for (std::size_t i = 0; i < count; ++i)
    image->pixels[i] = image->pixels[i + points.no_returns_before[i]];
  image->pixels.resize(count);
  return image;
}

}  // namespace

double secondsSince1970(const mrpt::obs::CObservation& observation) {
  if (observation.timestamp == INVALID_TIMESTAMP) return 0;
  return mrpt::Clock::toDouble(observation.timestamp);
}

AdaptedScan makeScan(const SensorPoints& points, const Eigen::Isometry3d& robot_pose,
                     const LabelRules& rules, const BeamRequest& beams) {
  const Eigen::Isometry3d sensor = sensorPoseInMap(robot_pose, points.sensor_pose);
  const Eigen::Matrix3d rotation = sensor.linear();
  AdaptedScan out;
  out.scan.origin = sensor.translation();
  out.no_returns = points.no_returns;
  out.scan.points.reserve(points.points.size());
  out.scan.labels.reserve(points.points.size());
  ImageOfKept image(points, out);
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const std::optional<ClassId> id = classOf(points.labels[i], rules, out.labels);
    if (!id) continue;
    const Eigen::Vector3d rotated = rotation * points.points[i].cast<double>();
    out.scan.points.push_back(rotated.cast<float>());
    out.scan.labels.push_back(*id);
    image.keep(i);
  }
  image.keepEmpty(rotation, beams.free_range, [&] { out.scan.labels.push_back(kFreeClass); });
  return out;
}

void searchForImage(const BeamRequest& beams, SensorPoints& points) {
  if (points.image_origin != ImageOrigin::Unknown) return;
  points.image_origin = ImageOrigin::None;
  if (!beams.images) return;
  std::optional<RangeImage> found = findImage(points);
  if (!found) return;
  points.image = *std::move(found);
  points.image_origin = ImageOrigin::Found;
}

BeamRequest beamsOf(const Options& options) {
  return {options.usesImages(), options.free_space.no_return ? options.scan.max_range : 0};
}

std::optional<std::vector<AdaptedScan>> SelfLabelledAdapter::adapt(
    const mrpt::obs::CObservation& observation, const Eigen::Isometry3d& robot_pose,
    const LabelRules& rules) {
  const PointExtractor* extractor = findPointExtractor(observation);
  if (extractor == nullptr) return std::nullopt;
  SensorPoints points = extractor->extract(observation, rules);
  searchForImage(beams(), points);
  AdaptedScan adapted = makeScan(points, robot_pose, rules, beams());
  adapted.timestamp = secondsSince1970(observation);
  adapted.sensor_label = observation.sensorLabel;
  adapted.observation_class = observationName(observation);
  std::vector<AdaptedScan> scans;
  scans.push_back(std::move(adapted));
  return scans;
}

std::unique_ptr<ObservationAdapter> SelfLabelledAdapter::clone() const {
  return std::make_unique<SelfLabelledAdapter>(*this);
}

void SelfLabelledAdapter::writeTo(ByteWriter& /*out*/) const {}

void SelfLabelledAdapter::readFrom(ByteReader& /*in*/, std::uint8_t /*version*/) {}

}  // namespace csom
