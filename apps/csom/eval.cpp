// SPDX-License-Identifier: BSD-3-Clause
// csom eval: how well a map, or what makes one, agrees with the truth.
#include <csom/eval/VoxelScore.h>
#include <csom/io/TextParser.h>
#include <csom/protocols/EvaluationJson.h>

#include <cstdio>
#include <memory>
#include <string>

#include "MapWithTruth.h"
#include "Output.h"
#include "commands.h"

namespace csom {

namespace {

struct EvalArguments {
  std::string map;
  std::string truth;
  bool json = false;
};

void printAsText(const VoxelScore& score, const LabelSet& labels) {
  const auto percent = [](double share) { return 100 * share; };
  std::printf("w-average IoU         %6.2f %%\n", percent(score.weightedAverageIou()));
  std::printf("geometric IoU         %6.2f %%  (precision %.2f %%, recall %.2f %%)\n",
              percent(score.geometricIou()), percent(score.geometricPrecision()),
              percent(score.geometricRecall()));
  std::printf("accurateness          %6.2f %%  where truth or map is occupied\n",
              percent(score.accuratenessOccupied()));
  std::printf("accurateness          %6.2f %%  of all %zu voxels\n\n",
              percent(score.accuratenessBox()), score.voxels());
  std::printf("  %-20s %10s %10s %8s %10s %8s %8s\n", "class", "true", "mapped", "IoU", "precision",
              "recall", "F1");
  for (int i = 1; i < score.numberOfClasses(); ++i) {
    const auto k = static_cast<ClassId>(i);
    if (score.truthCount(k) + score.predictedCount(k) == 0) continue;
    std::printf("  %-20s %10zu %10zu %8.2f %10.2f %8.2f %8.2f\n",
                detail::printable(labels.at(k).name).c_str(), score.truthCount(k),
                score.predictedCount(k), percent(score.iou(k)), percent(score.precision(k)),
                percent(score.recall(k)), percent(score.f1(k)));
  }
}

void runEvalVoxels(const EvalArguments& arguments) {
  const MapWithTruth both = loadMapWithTruth(arguments.map, arguments.truth);
  const VoxelScore score(both.map.map, both.truth.map);
  if (arguments.json)
    printJson(toJson(score, both.truth.labels));
  else
    printAsText(score, both.truth.labels);
}

}  // namespace

void addEvalCommand(CLI::App& program) {
  CLI::App* eval =
      program.add_subcommand("eval", "Score a map, or labels from a camera, against the truth");
  eval->require_subcommand(1);
  auto arguments = std::make_shared<EvalArguments>();
  CLI::App* voxels = eval->add_subcommand("voxels", "Voxel by voxel, against a map of the truth");
  voxels->description(
      "Scores a map against the truth, voxel by voxel: IoU of each class, their average weighted\n"
      "by frequency, and occupied against not. JSON has the confusion matrix too. The truth is a "
      "map too: 'csom simulate --truth'\n"
      "writes the exact one of a simulated world; of a labelled data set it is the map of all\n"
      "points made by the same ini with 'method = s-csm' and 'ds_resolution = 0', the majority\n"
      "class of the points in each voxel.");
  voxels->add_option("--map", arguments->map, "map to score (.csom)")->required();
  voxels->add_option("--truth", arguments->truth, "map of the truth (.csom)")->required();
  voxels->add_flag("--json", arguments->json, "print JSON");
  voxels->footer(
      "Example:\n"
      "  csom simulate config/worlds/room.yaml -o room.rawlog --truth truth.csom\n"
      "  csom map room.rawlog -c config/room.ini -o out\n"
      "  csom eval voxels --map out/map.csom --truth truth.csom");
  voxels->callback([arguments] { runEvalVoxels(*arguments); });
  addEvalPointsCommand(*eval);
  addEvalRocCommand(*eval);
  addEvalCameraCommand(*eval);
  addEvalRunCommand(*eval);
}

}  // namespace csom
