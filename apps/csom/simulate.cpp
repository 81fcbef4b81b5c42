// SPDX-License-Identifier: BSD-3-Clause
// csom simulate: a world file becomes a rawlog, and its exact truth a map.
#include <csom/core/Error.h>
#include <csom/eval/GroundTruth.h>
#include <csom/eval/Scenario.h>
#include <csom/io/MapFile.h>
#include <csom/io/TextParser.h>
#include <csom/rawlog/Simulation.h>
#include <csom/report/Format.h>

#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>

#include "Arguments.h"
#include "Output.h"
#include "OutputPaths.h"
#include "Progress.h"
#include "commands.h"

namespace csom {
namespace {

struct SimulateArguments {
  std::string world;
  std::string rawlog;
  std::string truth;
  std::optional<double> truth_resolution;
  std::optional<std::uint64_t> seed;
  SimulationOptions options;
  bool json = false;
};

struct TruthSummary {
  double resolution = 0;
  std::size_t occupied = 0;
  std::size_t free = 0;
};

Scenario load(const SimulateArguments& arguments) {
  Scenario scenario = loadScenario(arguments.world);
  if (arguments.seed) scenario.seed = *arguments.seed;
  if (arguments.truth_resolution) scenario.truth.resolution = *arguments.truth_resolution;
  return scenario;
}

VoxelBox truthBox(const Scenario& scenario) {
  try {
    return GroundTruth(scenario.world, scenario.truth.resolution).voxelsIn(scenario.truth.region);
  } catch (const std::invalid_argument& error) {
    throw ConfigError(scenario.file + ": truth: " + error.what());
  }
}

TruthSummary writeTruth(const Scenario& scenario, const VoxelBox& box, const std::string& file) {
  MapDocument document;
  document.map = GroundTruth(scenario.world, scenario.truth.resolution).toMap(box);
  document.labels = scenario.world.labels();
  document.meta["created_by"] = "csom simulate " CSOM_VERSION;
  document.meta["world"] = scenario.file;
  saveMap(document, file);

  TruthSummary summary{scenario.truth.resolution};
  document.map.forEachVoxel([&](const VoxelIndex&, const DirichletVoxel& voxel) {
    ++(voxel.state() == VoxelState::Free ? summary.free : summary.occupied);
  });
  return summary;
}

void printText(const SimulateArguments& arguments, const SimulationSummary& summary,
               const std::optional<TruthSummary>& truth) {
  std::printf("%s: %s frames, %s observations, %s labelled returns, %.1f s",
              arguments.rawlog.c_str(), formatCount(summary.frames).c_str(),
              formatCount(summary.observations).c_str(), formatCount(summary.returns).c_str(),
              summary.duration);
  if (summary.length > 0) std::printf(", %.1f m", summary.length);
  std::printf("\n");
  if (truth)
    std::printf("%s: %s occupied and %s free voxels of %g m\n",
                detail::printable(arguments.truth).c_str(), formatCount(truth->occupied).c_str(),
                formatCount(truth->free).c_str(), truth->resolution);
}

void printAsJson(const SimulateArguments& arguments, std::uint64_t seed,
                 const SimulationSummary& summary, const std::optional<TruthSummary>& truth) {
  Json json;
  json["world"] = arguments.world;
  json["rawlog"] = arguments.rawlog;
  json["seed"] = seed;
  json["frames"] = summary.frames;
  json["observations"] = summary.observations;
  json["labelled_returns"] = summary.returns;
  json["duration_s"] = summary.duration;
  json["length_m"] = summary.length;
  if (truth)
    json["truth"] = {{"file", arguments.truth},
                     {"resolution_m", truth->resolution},
                     {"occupied_voxels", truth->occupied},
                     {"free_voxels", truth->free}};
  printJson(json);
}

void simulate(const SimulateArguments& arguments) {
  std::vector<std::string> outputs{arguments.rawlog};
  for (const std::string& optional : {arguments.truth, arguments.options.trajectory_file})
    if (!optional.empty()) outputs.push_back(optional);
  requireSeparateOutputs(outputs, {arguments.world});
  const Scenario scenario = load(arguments);
  const VoxelBox truth_box = truthBox(scenario);
  SimulationSummary summary;
  {
    Progress progress("simulating");
    summary =
        simulateRawlog(scenario, arguments.rawlog, arguments.options,
                       [&](std::size_t done, std::size_t total) { progress.update(done, total); });
  }
  std::optional<TruthSummary> truth;
  if (!arguments.truth.empty()) truth = writeTruth(scenario, truth_box, arguments.truth);
  if (arguments.json) {
    printAsJson(arguments, scenario.seed, summary, truth);
  } else {
    printText(arguments, summary, truth);
  }
}

}  // namespace

void addSimulateCommand(CLI::App& program) {
  auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* command = program.add_subcommand(
      "simulate", "Drive a simulated robot through a world and record a rawlog");
  command->add_option("WORLD", arguments->world, "World file (see config/worlds)")->required();
  command->add_option("-o,--output", arguments->rawlog, "Rawlog to write (gz-compressed)")
      ->required();
  CLI::Option* truth = command->add_option("--truth", arguments->truth,
                                           "Map file (.csom) for the exact voxel truth");
  command
      ->add_option("--truth-resolution", arguments->truth_resolution,
                   "Voxel edge of the truth in metres instead of the world file's")
      ->check(CLI::Range(0.001, 1000.0))
      ->needs(truth);
  command->add_option("--trajectory", arguments->options.trajectory_file,
                      "File for the true poses, in TUM format");
  command->add_option("--seed", arguments->seed, "Seed of all noise instead of the world file's")
      ->check(CLI::NonNegativeNumber);
  const std::map<std::string, RawlogFormat> formats{{"sensory-frames", RawlogFormat::SensoryFrames},
                                                    {"observations", RawlogFormat::Observations}};
  command
      ->add_option("--format", arguments->options.format,
                   "sensory-frames (default): actions and CSensoryFrames, what rbpf-slam needs; "
                   "observations: one observation after the other")
      ->transform(oneOf(formats))
      ->type_name("FORMAT");
  command->add_flag("--json", arguments->json, "Print the figures as JSON");
  command->footer(
      "The same world file and seed give the same bytes.\n"
      "Examples:\n"
      "  csom simulate config/worlds/room.yaml -o room.rawlog --truth room-truth.csom\n"
      "  csom simulate config/worlds/campus.yaml -o campus.rawlog --trajectory campus.tum\n"
      "  csom simulate config/worlds/campus.yaml -o other.rawlog --seed 2");
  command->callback([arguments] { simulate(*arguments); });
}

}  // namespace csom
