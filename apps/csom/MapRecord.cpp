// SPDX-License-Identifier: BSD-3-Clause
// What a run of csom map leaves to its report.
#include "MapRecord.h"

#include <csom/io/TextParser.h>

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

template <class OptionsLike>
void append(std::vector<Parameter>& parameters, const OptionsLike& options) {
  const std::vector<Parameter> more = toParameters(options);
  parameters.insert(parameters.end(), more.begin(), more.end());
}

std::vector<Parameter> makeParameters(const CSemanticContinuousMap& map) {
  std::vector<Parameter> parameters = toParameters(map.map().options());
  append(parameters, map.insertionOptions);
  if (map.labelOptions.usesCameras()) append(parameters, map.labelOptions);
  return parameters;
}

std::vector<CameraPicture> makePictures(const MappingResult& result) {
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

RunRecord makeRecord(const MappingRequest& request, const MappingResult& result, double seconds) {
  RunRecord record;
  record.program_version = CSOM_VERSION;
  record.command = commandLine();
  record.inputs = request.logs;
  record.config_file = request.config_file;
  record.parameters = makeParameters(*result.map);
  record.pose_source = poseSourcesOf(result);
  record.up = result.up;
  record.label_set = result.map->labels().name();
  record.observations_read = result.observations_read;
  const auto& scans = result.map->scans();
  for (std::size_t i = 0; i < scans.size(); ++i)
    record.scans.push_back({scans[i], result.insert_ms.at(i)});
  const InsertionStatistics& statistics = result.map->statistics();
  record.unused = statistics.unused;
  record.labels = statistics.labels;
  record.no_returns = statistics.no_returns;
  record.images = statistics.images;
  for (const auto& [what, count] : result.refused)
    record.refused.push_back({what.first, what.second, count});
  record.camera_labels = result.map->cameraStatistics();
  record.deskew = result.deskew;
  if (result.registration) record.registration = result.registration->statistics;
  record.pictures = makePictures(result);
  record.warnings = result.warnings;
  record.wall_seconds = seconds;
  return record;
}

}  // namespace csom
