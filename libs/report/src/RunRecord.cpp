// SPDX-License-Identifier: BSD-3-Clause
// The run record and its JSON text.
#include <csom/report/ClassesJson.h>
#include <csom/report/Format.h>
#include <csom/report/RunRecord.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "StatisticsJson.h"
#include "TimingSummary.h"

namespace csom {

namespace {

// Keys stay in the order in which a reader wants them.
using Json = nlohmann::ordered_json;

/// Points that the map never saw.
std::size_t droppedForLabel(const RunRecord& record) {
  return record.labels.dropped() +
         (record.camera_labels ? record.camera_labels->points.dropped() : 0);
}

Json toJson(const Eigen::Vector3d& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

Json rejectsJson(const ScanReport& report) {
  Json json = Json::object();
  for (std::size_t i = 0; i < kRejectReasons; ++i)
    json[toString(static_cast<RejectReason>(i))] = report.rejected[i];
  return json;
}

Json parametersJson(const std::vector<Parameter>& parameters) {
  Json json = Json::object();
  for (const Parameter& parameter : parameters)
    std::visit([&](const auto& value) { json[parameter.name] = value; }, parameter.value);
  return json;
}

Json meaningsJson(const std::vector<Parameter>& parameters) {
  Json json = Json::object();
  for (const Parameter& parameter : parameters)
    json[parameter.name] = {{"unit", parameter.unit}, {"help", parameter.help}};
  return json;
}

Json picturesJson(const std::vector<CameraPicture>& pictures) {
  Json json = Json::array();
  for (const CameraPicture& picture : pictures)
    json.push_back({{"moment", toString(picture.moment)},
                    {"sensor_label", picture.sensor_label},
                    {"timestamp", picture.timestamp},
                    {"frame", picture.frame},
                    {"classes", picture.classes}});
  return json;
}

Json scanJson(const RunScan& scan) {
  const ScanRecord& record = scan.record;
  return {{"timestamp", record.timestamp},
          {"sensor_label", record.sensor_label},
          {"observation_class", record.observation_class},
          {"origin", record.origin},
          {"points", record.report.points},
          {"rejected", record.report.rejectedTotal()},
          {"training_points", record.report.training_points},
          {"voxels_updated", record.report.voxels_updated},
          {"insert_ms", scan.insert_ms},
          {"prepare_ms", record.report.prepare_ms},
          {"infer_ms", record.report.infer_ms},
          {"commit_ms", record.report.commit_ms}};
}

void addCameraRejects(Json& rejects, const CameraPointCounts& points) {
  rejects["unknown-label"] =
      rejects["unknown-label"].get<std::size_t>() + points.unknownAndDropped();
  rejects["ignored-label"] =
      rejects["ignored-label"].get<std::size_t>() + points.ignoredAndDropped();
  rejects["not-seen-by-camera"] = points.unseenAndDropped();
  rejects["low-confidence"] = points.low_confidence;
}

Json totalsJson(const RunRecord& record) {
  const ScanReport total = totals(record);
  Json json = {{"observations_read", record.observations_read},
               {"observations_inserted", record.scans.size()},
               {"points", pointsRead(record)},
               {"rejected", pointsRejected(record)},
               {"kept_unlabelled", record.labels.keptUnlabelled()},
               {"no_returns", record.no_returns}};
  if (record.camera_labels) json["outside_view"] = record.camera_labels->points.outsideAndDropped();
  Json rejects = rejectsJson(total);
  rejects["no-label"] = record.labels.missing;
  rejects["unknown-label"] = record.labels.unknown;
  rejects["ignored-label"] = record.labels.ignored;
  rejects["several-labels"] = record.labels.ambiguous;
  if (record.camera_labels) addCameraRejects(rejects, record.camera_labels->points);
  json["rejects"] = rejects;
  visitReport(total, [&](const std::string& name, const auto& field) {
    // Times are summed up under timing_ms.
    const bool is_count = std::is_integral_v<std::decay_t<decltype(field)>>;
    const bool is_reject = name.rfind("rejected_", 0) == 0;
    if (is_count && !is_reject && name != "points") json[name] = field;
  });
  return json;
}

Json refusedJson(const std::vector<RefusedObservations>& refused) {
  Json json = Json::array();
  for (const RefusedObservations& r : refused)
    json.push_back(
        {{"observation_class", r.observation_class}, {"reason", r.reason}, {"count", r.count}});
  return json;
}

Json timingJson(const RunRecord& record) {
  Json json = Json::object();
  for (const StageTiming& stage : summarizeTiming(record.scans))
    json[stage.key] = {{"total", stage.total},
                       {"min", stage.min},
                       {"median", stage.median},
                       {"p95", stage.p95},
                       {"max", stage.max}};
  return json;
}

Json mapJson(const MapFigures& figures) {
  Json bounds;  // null for an empty map
  if (!figures.bounds.isEmpty())
    bounds = {{"min", toJson(figures.bounds.min())}, {"max", toJson(figures.bounds.max())}};
  return {{"resolution", figures.resolution},
          {"known_voxels", figures.known_voxels},
          {"occupied_voxels", figures.occupied_voxels},
          {"free_voxels", figures.free_voxels},
          {"chunks", figures.chunks},
          {"memory_bytes", figures.memory_bytes},
          {"bounds", bounds},
          {"digest", figures.digest},
          {"classes", classesToJson(figures.classes)}};
}

Json imagesJson(const ImageCounts& images) {
  Json json = statisticsToJson(images);
  json["unused"] = images.unused();
  return json;
}

Json cameraLabelsJson(const RunRecord& record) {
  const CameraStatistics& labels = *record.camera_labels;
  const std::optional<double> added = addedShare(record);
  Json cameras = Json::array();
  for (const CameraStatistics::Camera& camera : labels.cameras)
    cameras.push_back({{"sensor_label", camera.sensor_label},
                       {"source", camera.source},
                       {"images", imagesJson(camera.images)}});
  Json json = {{"images", imagesJson(labels.images())}};
  json.update(statisticsToJson(labels));
  json["added_share"] = added ? Json(*added) : Json();
  json["cameras"] = cameras;
  return json;
}

/// The report of a scan or of several, with its reasons of rejection apart.
Json reportJson(const ScanReport& report) {
  Json json = Json::object();
  visitReport(report, [&](const std::string& name, const auto& field) { json[name] = field; });
  return json;
}

/// Sections that only some runs have.
void addCameraSections(Json& json, const RunRecord& record) {
  if (record.camera_labels) json["camera_labels"] = cameraLabelsJson(record);
  if (record.deskew) json["deskew"] = statisticsToJson(*record.deskew);
  if (record.registration) json["registration"] = statisticsToJson(*record.registration);
}

}  // namespace

Json classesToJson(const std::vector<ClassFigures>& classes) {
  Json json = Json::array();
  for (const ClassFigures& c : classes)
    json.push_back({{"id", c.id},
                    {"name", c.name},
                    {"color", c.color},
                    {"voxels", c.voxels},
                    {"volume_m3", c.volume},
                    {"share", c.share},
                    {"mean_probability", c.mean_probability}});
  return json;
}

std::string toText(const Parameter& parameter) {
  struct {
    std::string operator()(bool value) const { return toString(value); }
    std::string operator()(std::int64_t value) const { return std::to_string(value); }
    std::string operator()(double value) const { return toString(value); }
    std::string operator()(const std::string& value) const { return value; }
  } text;
  return std::visit(text, parameter.value);
}

ScanReport totals(const RunRecord& record) {
  ScanReport sum = record.unused;
  for (const RunScan& scan : record.scans) sum += scan.record.report;
  return sum;
}

std::size_t pointsRead(const RunRecord& record) {
  return totals(record).points + droppedForLabel(record);
}

std::size_t pointsRejected(const RunRecord& record) {
  return totals(record).rejectedTotal() + record.labels.dropped() +
         (record.camera_labels ? record.camera_labels->points.rejected() : 0);
}

std::string describeImages(const ScanImageCounts& images) {
  std::string text;
  const auto add = [&](std::size_t count, const char* how) {
    if (count > 0) text += (text.empty() ? "" : ", ") + formatCount(count, "scan") + " " + how;
  };
  add(images.of_sensor, "with the range image of the sensor");
  add(images.found, "with rows found in the points");
  add(images.none, "without rows: neighbours in space");
  return text;
}

std::optional<double> addedShare(const RunRecord& record) {
  const double network = record.camera_labels ? record.camera_labels->seconds.network : 0;
  if (!(network > 0)) return std::nullopt;
  return (record.wall_seconds - network) / network;
}

std::string toJson(const RunRecord& record, const MapFigures& figures) {
  Json scans = Json::array();
  for (const RunScan& scan : record.scans) scans.push_back(scanJson(scan));
  Json json = {{"program", "csom"},
               {"program_version", record.program_version},
               {"command", record.command},
               {"inputs", record.inputs},
               {"config_file", record.config_file},
               {"pose_source", record.pose_source},
               {"up", {record.up.x(), record.up.y(), record.up.z()}},
               {"label_set", record.label_set},
               {"parameters", parametersJson(record.parameters)},
               {"parameter_meanings", meaningsJson(record.parameters)},
               {"wall_seconds", record.wall_seconds},
               {"totals", totalsJson(record)},
               {"unused", reportJson(record.unused)},
               {"labels", statisticsToJson(record.labels)},
               {"scan_images", statisticsToJson(record.images)},
               {"refused", refusedJson(record.refused)},
               {"warnings", record.warnings},
               {"timing_ms", timingJson(record)}};
  addCameraSections(json, record);
  json["pictures"] = picturesJson(record.pictures);
  json["map"] = mapJson(figures);
  json["scans"] = scans;
  // nlohmann writes numbers that are not finite as null.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace csom
