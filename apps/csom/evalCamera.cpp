// SPDX-License-Identifier: BSD-3-Clause
// csom eval camera: how well points take their labels from a camera, in a simulated world.
#include <csom/core/Error.h>
#include <csom/eval/Scenario.h>
#include <csom/io/TemporaryFolder.h>
#include <csom/io/TextParser.h>
#include <csom/rawlog/CameraLabelScore.h>
#include <csom/rawlog/Simulation.h>
#include <csom/report/Format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "Output.h"
#include "Progress.h"
#include "commands.h"

namespace csom {
namespace {

struct EvalCameraArguments {
  std::string world;
  std::string rawlog;
  PointLabellingOptions labelling;
  bool json = false;
};

CameraLabelScore simulateAndScore(const Scenario& scenario,
                                  const PointLabellingOptions& labelling) {
  const TemporaryFolder folder;
  const std::string rawlog = folder.file("simulated.rawlog");
  {
    Progress progress("simulating");
    simulateRawlog(scenario, rawlog, {},
                   [&](std::size_t done, std::size_t total) { progress.update(done, total); });
  }
  return scoreCameraLabels(scenario, rawlog, labelling);
}

Json toJson(const FateCounts& fates) {
  Json json;
  for (std::size_t i = 0; i < kPointFates; ++i) {
    const auto fate = static_cast<PointFate>(i);
    if (fate != PointFate::OutsideView) json[toString(fate)] = fates[i];
  }
  return json;
}

Json toJson(const CameraLabelTally& tally) {
  Json json;
  json["points_in_view"] = tally.in_view;
  json["truly_visible"] = tally.visible;
  json["fates"] = toJson(tally.fates);
  json["fates_of_truly_visible"] = toJson(tally.visible_fates);
  json["correct_share"] = tally.correctShare();
  json["naive_correct_share"] = tally.naiveCorrectShare();
  json["lost_share"] = tally.lostShare();
  return json;
}

void printAsJson(const CameraLabelScore& score, const LabelSet& labels) {
  Json json;
  json["scans"] = score.scans;
  json["scans_without_image"] = score.scans_without_image;
  json["all"] = toJson(score.all);
  json["classes"] = Json::object();
  for (const LabelClass& c : labels.classes()) {
    if (score.by_class[c.id].in_view > 0) json["classes"][c.name] = toJson(score.by_class[c.id]);
  }
  printJson(json);
}

double percent(double share) {
  return 100 * share;
}

void printAsText(const CameraLabelScore& score, const LabelSet& labels) {
  const CameraLabelTally& all = score.all;
  std::printf("%s points in view of a camera in %s scans", formatCount(all.in_view).c_str(),
              formatCount(score.scans).c_str());
  if (score.scans_without_image > 0)
    std::printf(" (%s more scans without an image)",
                formatCount(score.scans_without_image).c_str());
  std::printf("\n\ncorrect labels        %6.2f %%  of the labelled points\n",
              percent(all.correctShare()));
  std::printf("  naive projection    %6.2f %%  without visibility and edges\n",
              percent(all.naiveCorrectShare()));
  std::printf("lost                  %6.2f %%  of the truly visible points\n\n",
              percent(all.lostShare()));
  std::printf("  %-20s %10s %14s\n", "fate", "points", "truly visible");
  for (std::size_t i = 0; i < kPointFates; ++i) {
    if (all.fates[i] > 0)
      std::printf("  %-20s %10zu %14zu\n", toString(static_cast<PointFate>(i)), all.fates[i],
                  all.visible_fates[i]);
  }
  std::printf("\n  %-20s %10s %14s %10s %9s %8s %7s\n", "class", "in view", "truly visible",
              "labelled", "correct", "naive", "lost");
  for (const LabelClass& c : labels.classes()) {
    const CameraLabelTally& tally = score.by_class[c.id];
    if (tally.in_view > 0)
      std::printf("  %-20s %10zu %14zu %10zu %9.2f %8.2f %7.2f\n",
                  detail::printable(c.name).c_str(), tally.in_view, tally.visible, tally.labelled(),
                  percent(tally.correctShare()), percent(tally.naiveCorrectShare()),
                  percent(tally.lostShare()));
  }
}

void runEvalCamera(const EvalCameraArguments& arguments) {
  arguments.labelling.validate();
  const Scenario scenario = loadScenario(arguments.world);
  const CameraLabelScore score =
      arguments.rawlog.empty() ? simulateAndScore(scenario, arguments.labelling)
                               : scoreCameraLabels(scenario, arguments.rawlog, arguments.labelling);
  if (arguments.json) {
    printAsJson(score, scenario.world.labels());
  } else {
    printAsText(score, scenario.world.labels());
  }
}

}  // namespace

void addEvalCameraCommand(CLI::App& eval) {
  auto arguments = std::make_shared<EvalCameraArguments>();
  CLI::App* camera = eval.add_subcommand("camera", "Labels of points from a camera, simulated");
  camera->description(
      "Scores the labels that the points of a Velodyne take from the images of a camera, in a\n"
      "simulated world: the share of labelled points with the class of the surface they lie on,\n"
      "beside that of the naive projection, and the share of the truly visible points (nothing\n"
      "stands between them and the camera) that were rejected as hidden or at an edge. The world\n"
      "needs a Velodyne with 'intensity: class' and a camera.");
  camera->add_option("WORLD", arguments->world, "World file (see config/worlds)")->required();
  camera->add_option("--rawlog", arguments->rawlog,
                     "A rawlog that was simulated from the world; without it, it is simulated now");
  camera
      ->add_option("--visibility-margin", arguments->labelling.visibility_margin,
                   "What is nearer to the camera by less does not hide [m]")
      ->capture_default_str();
  camera
      ->add_option("--edge-margin", arguments->labelling.edge_margin,
                   "How far labels may bleed over a jump of the depth [px]; 0: no edges")
      ->capture_default_str();
  camera->add_flag("--json", arguments->json, "Print the figures as JSON");
  camera->footer(
      "Example:\n"
      "  csom eval camera config/worlds/campus.yaml --rawlog rawlogs/campus.rawlog");
  camera->callback([arguments] { runEvalCamera(*arguments); });
}

}  // namespace csom
