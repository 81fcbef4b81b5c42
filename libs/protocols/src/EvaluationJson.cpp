// SPDX-License-Identifier: BSD-3-Clause
#include <csom/protocols/EvaluationJson.h>

namespace csom {
namespace {

using Json = nlohmann::ordered_json;

/// The names of the classes that either side of a matrix has, free first.
std::vector<ClassId> classesOf(const ConfusionMatrix& matrix) {
  std::vector<ClassId> found;
  for (int i = 0; i < matrix.numberOfClasses(); ++i) {
    const auto k = static_cast<ClassId>(i);
    if (matrix.truthCount(k) + matrix.predictedCount(k) > 0) found.push_back(k);
  }
  return found;
}

Json computeConfusion(const ConfusionMatrix& matrix, const LabelSet& labels) {
  Json json;
  const std::vector<ClassId> classes = classesOf(matrix);
  for (const ClassId k : classes) json["classes"].push_back(labels.at(k).name);
  json["rows"] = "truth";
  for (const ClassId truth : classes) {
    Json row;
    for (const ClassId predicted : classes) row.push_back(matrix.count(truth, predicted));
    json["counts"].push_back(row);
  }
  return json;
}

void addClasses(Json& json, const ConfusionMatrix& matrix, const LabelSet& labels) {
  for (const char* key : {"iou", "class_precision", "class_recall", "f1"})
    json[key] = Json::object();
  for (const ClassId k : classesOf(matrix)) {
    if (k == kFreeClass) continue;
    const std::string& name = labels.at(k).name;
    json["iou"][name] = matrix.iou(k);
    json["class_precision"][name] = matrix.precision(k);
    json["class_recall"][name] = matrix.recall(k);
    json["f1"][name] = matrix.f1(k);
  }
}

void addOccupancy(Json& json, const VoxelScore& score) {
  json["geometric_iou"] = score.geometricIou();
  json["precision"] = score.geometricPrecision();
  json["recall"] = score.geometricRecall();
  json["occupied_f1"] = score.geometricF1();
  json["free_iou"] = score.freeIou();
}

void addRoc(Json& json, const RocFigures& roc, const std::string& suffix) {
  json["auc" + suffix] = roc.auc;
  json["tpr_at_fpr_0.2" + suffix] = roc.tpr_at_fpr_02;
  Json curve = Json::array();
  for (const RocPoint& point : roc.curve)
    curve.push_back({point.false_positive_rate, point.true_positive_rate});
  json["roc" + suffix] = std::move(curve);
}

}  // namespace

Json toJson(const VoxelScore& score, const LabelSet& labels) {
  Json json;
  json["w_average_iou"] = score.weightedAverageIou();
  addClasses(json, score.matrix(), labels);
  json["macro_f1"] = score.macroF1();
  addOccupancy(json, score);
  json["accurateness"] = score.accuratenessOccupied();
  json["accurateness_box"] = score.accuratenessBox();
  json["voxels"] = score.voxels();
  json["confusion"] = computeConfusion(score.matrix(), labels);
  return json;
}

namespace {

Json figures(const VoxelFigures& voxels, bool classes, const LabelSet& labels) {
  Json json;
  if (classes) {
    json = toJson(voxels.score, labels);
  } else {
    addOccupancy(json, voxels.score);
    json["accurateness_box"] = voxels.score.accuratenessBox();
    json["voxels"] = voxels.score.voxels();
  }
  json["known_voxels"] = voxels.known_share;
  json["known_free_iou"] = voxels.known_free_iou;
  if (voxels.roc_unknown_half) addRoc(json, *voxels.roc_unknown_half, "");
  if (voxels.roc_unknown_zero) addRoc(json, *voxels.roc_unknown_zero, "_unknown_zero");
  if (voxels.calibration.count() > 0) {
    json["brier"] = voxels.calibration.brier();
    json["ece"] = voxels.calibration.expectedCalibrationError();
    json["occupancy_brier"] = voxels.occupancy_calibration.brier();
    json["occupancy_ece"] = voxels.occupancy_calibration.expectedCalibrationError();
  }
  return json;
}

Json toJson(const std::array<SightFigures, kSightSeconds.size()>& sight) {
  Json json = Json::array();
  for (std::size_t i = 0; i < sight.size(); ++i)
    json.push_back({{"seconds", kSightSeconds[i]},
                    {"left_by_movers", sight[i].left_by_movers},
                    {"ghosts", sight[i].ghosts},
                    {"stays", sight[i].stays},
                    {"lost", sight[i].lost}});
  return json;
}

}  // namespace

Json toJson(const PointScore& score, const LabelSet& labels) {
  Json json;
  json["miou_points"] = score.meanIou();
  json["accuracy_points"] = score.accuracy();
  json["miou_points_occupied"] = score.occupiedMeanIou();
  json["accuracy_points_occupied"] = score.occupiedAccuracy();
  json["miou_points_covered"] = score.coveredMeanIou();
  json["accuracy_points_covered"] = score.coveredAccuracy();
  json["coverage"] = score.coverage();
  if (score.calibration().count() > 0) {
    json["brier"] = score.calibration().brier();
    json["ece"] = score.calibration().expectedCalibrationError();
  }
  json["points"] = score.points();
  json["iou_points"] = Json::object();
  for (const ClassId k : score.matrix().classesInTruth())
    json["iou_points"][labels.at(k).name] = score.matrix().iou(k);
  return json;
}

Json toJson(const TrialResult& result, const LabelSet& labels) {
  Json json;
  json["variant"] = result.variant;
  json["method"] = result.method;
  json["scans"] = result.scans;
  json.update(figures(result.voxels, result.classes, labels));
  if (result.points) json.update(toJson(*result.points, labels));
  if (result.sight) json["clear_sight"] = toJson(*result.sight);
  if (result.seen) json["seen"] = figures(*result.seen, result.classes, labels);
  json["ms_per_scan"] = result.ms_per_scan;
  return json;
}

Json toJson(const Evaluation& evaluation) {
  Json json;
  json["protocols"] = Json::object();
  for (const TrialResult& result : evaluation.results)
    json["protocols"][result.protocol]["results"].push_back(
        toJson(result, evaluation.labels.at(result.protocol)));
  for (auto& [name, protocol] : json["protocols"].items()) {
    for (const ProtocolInfo& info : allProtocols())
      if (info.name == name) protocol["title"] = info.title;
    protocol["source"] = evaluation.sources.at(name);
  }
  if (evaluation.predictions)
    json["protocols"]["P3"]["input_labels"] =
        toJson(*evaluation.predictions, evaluation.labels.at("P3"));
  json["left_out"] = Json::array();
  for (const LeftOutProtocol& left : evaluation.left_out)
    json["left_out"].push_back({{"protocol", left.name}, {"reason", left.reason}});
  json["warnings"] = evaluation.warnings;
  return json;
}

}  // namespace csom
