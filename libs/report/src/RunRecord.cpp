// SPDX-License-Identifier: BSD-3-Clause
// The run record and its JSON text.
#include <csom/report/ClassesJson.h>
#include <csom/report/RunRecord.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "TimingSummary.h"

namespace csom {

namespace {

// Keys stay in the order in which a reader wants them.
using Json = nlohmann::ordered_json;

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

Json totalsJson(const RunRecord& record) {
  const ScanReport total = totals(record);
  Json json = {{"observations_read", record.observations_read},
               {"observations_inserted", record.scans.size()},
               {"points", pointsRead(record)},
               {"rejected", pointsRejected(record)}};
  Json rejects = rejectsJson(total);
  rejects["no-label"] = record.label_rejects.missing;
  rejects["unknown-label"] = record.label_rejects.unknown;
  rejects["ignored-label"] = record.label_rejects.ignored;
  rejects["several-labels"] = record.label_rejects.ambiguous;
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

std::vector<Parameter> parametersOf(const Options& options) {
  std::vector<Parameter> parameters;
  visitOptions(options,
               [&](const char* name, const auto& field, const char* unit, const char* help) {
                 using Field = std::decay_t<decltype(field)>;
                 Parameter parameter{name, std::string(), unit, help};
                 if constexpr (std::is_same_v<Field, bool> || std::is_same_v<Field, double>)
                   parameter.value = field;
                 else if constexpr (std::is_integral_v<Field>)
                   parameter.value = static_cast<std::int64_t>(field);
                 else
                   parameter.value = toString(field);
                 parameters.push_back(std::move(parameter));
               });
  return parameters;
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
  return totals(record).points + record.label_rejects.total();
}

std::size_t pointsRejected(const RunRecord& record) {
  return totals(record).rejectedTotal() + record.label_rejects.total();
}

std::string toJson(const RunRecord& record, const MapFigures& figures) {
  Json scans = Json::array();
  for (const RunScan& scan : record.scans) scans.push_back(scanJson(scan));
  const Json json = {{"program", "csom"},
                     {"program_version", record.program_version},
                     {"command", record.command},
                     {"inputs", record.inputs},
                     {"config_file", record.config_file},
                     {"pose_source", record.pose_source},
                     {"up", {record.up.x(), record.up.y(), record.up.z()}},
                     {"label_set", record.label_set},
                     {"parameters", parametersJson(record.parameters)},
                     {"wall_seconds", record.wall_seconds},
                     {"totals", totalsJson(record)},
                     {"refused", refusedJson(record.refused)},
                     {"warnings", record.warnings},
                     {"timing_ms", timingJson(record)},
                     {"map", mapJson(figures)},
                     {"scans", scans}};
  // nlohmann writes numbers that are not finite as null.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace csom
