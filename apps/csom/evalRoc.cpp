// SPDX-License-Identifier: BSD-3-Clause
// csom eval roc: how well a map tells occupied from free, and whether its probabilities hold.
#include <csom/core/Error.h>
#include <csom/eval/CsomMapper.h>
#include <csom/eval/VoxelEvaluation.h>

#include <cstdio>
#include <memory>
#include <utility>

#include "MapWithTruth.h"
#include "Output.h"
#include "commands.h"

namespace csom {
namespace {

constexpr double kFalsePositiveRate = 0.2;
constexpr std::size_t kCurvePoints = 200;

struct EvalRocArguments {
  std::string map;
  std::string truth;
  bool json = false;
};

struct Curves {
  RocCurve unknown_half;
  RocCurve unknown_zero;
};

Curves makeCurves(const VoxelEvaluation& evaluation, const std::string& truth_file) {
  const auto half = evaluation.occupancy.curve(0.5);
  const auto zero = evaluation.occupancy.curve(0);
  if (!half || !zero)
    throw FileError(truth_file,
                    "knows no free voxels (or no occupied ones), without which there is no curve; "
                    "take the exact truth of a simulated world");
  return {*half, *zero};
}

void addCurve(Json& json, const RocCurve& curve, const std::string& suffix) {
  json["auc" + suffix] = curve.auc();
  json["tpr_at_fpr_0.2" + suffix] = curve.truePositiveRateAt(kFalsePositiveRate);
  for (const RocPoint& point : curve.thinned(kCurvePoints))
    json["roc" + suffix].push_back({point.false_positive_rate, point.true_positive_rate});
}

void runEvalRoc(const EvalRocArguments& arguments) {
  MapWithTruth both = loadMapWithTruth(arguments.map, arguments.truth);
  const VoxelEvaluation evaluation =
      evaluateVoxels(CsomMapper(std::move(both.map.map)), VoxelTruth(both.truth.map));
  const Curves curves = makeCurves(evaluation, arguments.truth);
  const double known =
      static_cast<double>(evaluation.known) / static_cast<double>(evaluation.score.voxels());
  if (arguments.json) {
    Json json;
    addCurve(json, curves.unknown_half, "");
    addCurve(json, curves.unknown_zero, "_unknown_zero");
    json["known_voxels"] = known;
    json["brier"] = evaluation.calibration.brier();
    json["ece"] = evaluation.calibration.expectedCalibrationError();
    json["occupancy_brier"] = evaluation.occupancy_calibration.brier();
    json["occupancy_ece"] = evaluation.occupancy_calibration.expectedCalibrationError();
    printJson(json);
    return;
  }
  const auto line = [](const char* unknown, const RocCurve& curve) {
    std::printf("unknown voxels score %-4s AUC %.4f, TPR at FPR 0.2 %.4f\n", unknown, curve.auc(),
                curve.truePositiveRateAt(kFalsePositiveRate));
  };
  line("0.5", curves.unknown_half);
  line("0", curves.unknown_zero);
  std::printf("known voxels              %.2f %%\n", 100 * known);
  std::printf("of classes and free       Brier %.4f, ECE %.4f\n", evaluation.calibration.brier(),
              evaluation.calibration.expectedCalibrationError());
  std::printf("of occupied and free      Brier %.4f, ECE %.4f\n",
              evaluation.occupancy_calibration.brier(),
              evaluation.occupancy_calibration.expectedCalibrationError());
}

}  // namespace

void addEvalRocCommand(CLI::App& eval) {
  auto arguments = std::make_shared<EvalRocArguments>();
  CLI::App* roc = eval.add_subcommand("roc", "Occupied against free, whatever the threshold");
  roc->description(
      "The ROC curve of the probability that a voxel is occupied, over the voxels that the truth\n"
      "knows to be free or occupied, with voxels that the map does not know at 0.5 and at 0; and\n"
      "Brier score and expected calibration error (15 bins) over the voxels that it knows.");
  roc->add_option("--map", arguments->map, "map to score (.csom)")->required();
  roc->add_option("--truth", arguments->truth, "map of the truth (.csom), with free voxels")
      ->required();
  roc->add_flag("--json", arguments->json, "print JSON, with the points of the curves");
  roc->footer(
      "Example:\n"
      "  csom simulate config/worlds/room.yaml -o room.rawlog --truth truth.csom\n"
      "  csom map room.rawlog -c config/room.ini -o out\n"
      "  csom eval roc --map out/map.csom --truth truth.csom");
  roc->callback([arguments] { runEvalRoc(*arguments); });
}

}  // namespace csom
