// SPDX-License-Identifier: BSD-3-Clause
// What a run of csom map leaves to its report.
#include "MapRecord.h"

#include <csom/io/TextParser.h>

#include <type_traits>

#include "CameraPictures.h"
#include "CommandLine.h"

namespace csom {
namespace {

std::string poseSourcesOf(const MappingResult& result) {
  std::vector<std::string> names;
  for (const MappedLog& log : result.logs) {
    const std::string name = log.poses.toString();
    if (names.empty() || names.back() != name) names.push_back(name);
  }
  return detail::joined(names);
}

/// Words as text, numbers and switches as such.
template <class Field>
decltype(Parameter::value) parameterValue(const Field& field) {
  if constexpr (std::is_arithmetic_v<Field>)
    return field;
  else
    return toString(field);
}

std::vector<Parameter> parametersOf(const CSemanticContinuousMap& map) {
  std::vector<Parameter> parameters = parametersOf(map.map().options());
  const auto& labels = map.insertionOptions;
  parameters.push_back(
      {"point_labels", toString(labels.point_labels), "", "none | intensity | color"});
  parameters.push_back(
      {"unlabelled_class", labels.unlabelled_class, "", "class of points without a label"});
  parameters.push_back({"scan_2d_class", labels.scan_2d_class, "", "class of 2-D scans"});
  if (!map.labelOptions.usesCameras()) return parameters;
  visitLabelOptions(map.labelOptions,
                    [&](const char* key, const auto& field, const char* unit, const char* help) {
                      parameters.push_back({key, parameterValue(field), unit, help});
                    });
  return parameters;
}

CameraLabels cameraLabelsOf(const CameraStatistics& statistics) {
  CameraLabels labels;
  for (const CameraStatistics::Source& source : statistics.sources) {
    CameraSource camera;
    camera.sensor_label = source.sensor_label;
    camera.source = toString(source.kind);
    camera.images.read = source.images_read;
    camera.images.used = source.images_used;
    camera.images.network_runs = source.network_runs;
    camera.images.from_cache = source.from_cache;
    camera.images.refused = source.images_refused;
    camera.images.unused = source.images_read - source.images_used - source.images_refused;
    labels.cameras.push_back(camera);
  }
  labels.scans.labelled = statistics.scans_labelled;
  labels.scans.without_image = statistics.scans_without_image;
  labels.scans.late = statistics.scans_late;
  labels.clock_restarts = statistics.restarts;
  const auto points = [&](PointFate fate) {
    return statistics.points[static_cast<std::size_t>(fate)];
  };
  labels.points.labelled = points(PointFate::Labelled);
  labels.points.outside_view = points(PointFate::OutsideView);
  labels.points.hidden = points(PointFate::Hidden);
  labels.points.at_edge = points(PointFate::AtEdge);
  labels.points.low_confidence = points(PointFate::LowConfidence);
  labels.points.ignored = points(PointFate::Ignored);
  labels.points.unknown = points(PointFate::Unknown);
  labels.points.kept_unlabelled = statistics.kept_unlabelled;
  labels.seconds.network = statistics.network_seconds;
  labels.seconds.image_decoding = statistics.image_seconds;
  labels.seconds.labelling = statistics.labelling_seconds;
  return labels;
}

std::vector<CameraPicture> picturesOf(const MappingResult& result) {
  std::vector<CameraPicture> pictures;
  const auto add = [&](const std::optional<LabelledScan>& scan, CameraPicture::Moment moment) {
    if (!scan) return;
    for (CameraPicture& picture : cameraPictures(*scan, moment, result.map->labels()))
      pictures.push_back(std::move(picture));
  };
  add(result.first_labelled, CameraPicture::Moment::First);
  add(result.middle_labelled, CameraPicture::Moment::Middle);
  add(result.last_labelled, CameraPicture::Moment::Last);
  return pictures;
}

}  // namespace

RunRecord recordOf(const MappingRequest& request, const MappingResult& result, double seconds) {
  RunRecord record;
  record.program_version = CSOM_VERSION;
  record.command = commandLine();
  record.inputs = request.logs;
  record.config_file = request.config_file;
  record.parameters = parametersOf(*result.map);
  record.pose_source = poseSourcesOf(result);
  record.up = result.up;
  record.label_set = result.map->labels().name();
  record.observations_read = result.observations_read;
  const auto& scans = result.map->scans();
  for (std::size_t i = 0; i < scans.size(); ++i)
    record.scans.push_back({scans[i], result.insert_ms.at(i)});
  const InsertionStatistics& statistics = result.map->statistics();
  record.unused = statistics.unused;
  record.label_rejects = {statistics.labels.missing, statistics.labels.unknown,
                          statistics.labels.ignored, statistics.labels.ambiguous};
  record.kept_unlabelled = statistics.labels.unlabelled + statistics.labels.kept_unknown;
  record.no_returns = statistics.no_returns;
  for (const auto& [what, count] : result.refused)
    record.refused.push_back({what.first, what.second, count});
  if (const auto cameras = result.map->cameraStatistics())
    record.camera_labels = cameraLabelsOf(*cameras);
  if (const auto& done = result.deskew)
    record.deskew = DeskewCounts{done->deskewed, done->not_needed, done->not_possible};
  if (const auto& done = result.registration)
    record.registration = RegistrationRecord{done->scans, done->doubtful, done->seconds};
  record.pictures = picturesOf(result);
  record.warnings = result.warnings;
  record.wall_seconds = seconds;
  return record;
}

}  // namespace csom
