// SPDX-License-Identifier: BSD-3-Clause
// csom map: rawlogs become a map and a report.
#include <csom/core/Error.h>
#include <csom/io/MapFile.h>
#include <csom/io/OutputFile.h>
#include <csom/io/TextParser.h>
#include <csom/maps/DefaultIni.h>
#include <csom/rawlog/MappingRun.h>
#include <csom/rawlog/RawlogWriter.h>
#include <csom/report/Format.h>
#include <csom/report/MapFigures.h>
#include <csom/report/Report.h>
#include <csom/report/RunRecord.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>

#include "CommandLine.h"
#include "MapRecord.h"
#include "MappingStatus.h"
#include "OutputFolder.h"
#include "OutputPaths.h"
#include "Progress.h"
#include "commands.h"

namespace csom {
namespace {

struct MapArguments {
  std::vector<std::string> logs;
  std::string config;
  std::string output;
  std::string poses;
  std::optional<int> threads;
  std::string label_cache;
  std::string simplemap;
  bool no_deskew = false;
  bool no_html = false;
  bool color_blind = false;
  bool json = false;
};

MappingRequest requestOf(const MapArguments& arguments) {
  MappingRequest request;
  request.logs = arguments.logs;
  request.config_file = arguments.config;
  if (!arguments.poses.empty()) request.poses = PoseChoice::parse(arguments.poses);
  request.threads = arguments.threads;
  if (!arguments.label_cache.empty()) request.label_cache = arguments.label_cache;
  request.deskew = !arguments.no_deskew;
  request.keep_key_frames = !arguments.simplemap.empty();
  return request;
}

MappingResult mapWithProgress(const MappingRequest& request) {
  Progress progress("mapping");
  return mapLogs(request, [&](const MappingProgress& now) {
    progress.update(now.entries_done, now.entries,
                    [&](double seconds) { return mappingStatus(now, seconds); });
  });
}

MapDocument documentOf(const RunRecord& record, const MappingResult& result) {
  MapDocument document = result.map->document();
  document.meta["created_by"] = "csom " + record.program_version;
  document.meta["command"] = record.command;
  document.meta["rawlog"] = detail::joined(record.inputs);
  document.meta["poses"] = record.pose_source;
  return document;
}

void printSummary(const RunRecord& record, const MapFigures& figures, const OutputFolder& folder,
                  bool html) {
  std::printf("scans     %s with %s, poses: %s\n", formatCount(record.scans.size()).c_str(),
              formatCount(pointsRead(record), "point").c_str(),
              detail::printable(record.pose_source).c_str());
  if (pointsRejected(record) > 0)
    std::printf("rejected  %s points (reasons in run.json)\n",
                formatCount(pointsRejected(record)).c_str());
  if (const auto& cameras = record.camera_labels)
    std::printf("cameras   %s labelled; %s outside of their view, %s hidden or at an edge\n",
                formatCount(cameras->points.labelled, "point").c_str(),
                formatCount(cameras->points.outside_view).c_str(),
                formatCount(cameras->points.hidden + cameras->points.at_edge).c_str());
  for (const RefusedObservations& refused : record.refused)
    std::printf("unused    %s %s: %s\n", formatCount(refused.count).c_str(),
                detail::printable(refused.observation_class).c_str(),
                detail::printable(refused.reason).c_str());
  std::printf("map       %s voxels known, %s occupied, %.1f MB in memory: %s\n",
              formatCount(figures.known_voxels).c_str(),
              formatCount(figures.occupied_voxels).c_str(),
              static_cast<double>(figures.memory_bytes) / 1e6, folder.file("map.csom").c_str());
  std::printf("time      %.2f s\n", record.wall_seconds);
  std::printf("report    %s\n", folder.file(html ? "report.html" : "run.json").c_str());
}

void writeSimpleMap(const mrpt::maps::CSimpleMap& key_frames, const std::string& file) {
  RawlogWriter writer(file);
  writer.write(key_frames);
  writer.commit();
}

void runMap(const MapArguments& arguments) {
  if (arguments.output.empty()) throw ConfigError("--output is empty: name a folder");
  const MappingRequest request = requestOf(arguments);
  std::vector<std::string> inputs = arguments.logs;
  inputs.push_back(arguments.config);
  if (request.poses && request.poses->takesFile()) inputs.push_back(request.poses->argument);
  std::vector<std::string> names = reportFiles();
  names.push_back("map.csom");
  names.push_back("trajectory.tum");
  const OutputFolder folder(arguments.output, names);
  std::vector<std::string> outputs;
  for (const std::string& name : folder.results()) outputs.push_back(folder.file(name));
  if (!arguments.simplemap.empty()) outputs.push_back(arguments.simplemap);
  requireSeparateOutputs(outputs, inputs);
  if (!arguments.simplemap.empty()) OutputFile(arguments.simplemap);  // can it be written?

  const auto start = std::chrono::steady_clock::now();
  const MappingResult result = mapWithProgress(request);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  for (const std::string& warning : result.warnings)
    std::fprintf(stderr, "csom: warning: %s\n", detail::printable(warning).c_str());

  const RunRecord record = recordOf(request, result, elapsed.count());
  const MapDocument document = documentOf(record, result);
  StagedResults results(folder);
  saveMap(document, results.file("map.csom"));
  if (result.registration) writeTumTrajectory(result.trajectory, results.file("trajectory.tum"));
  ReportOptions report;
  report.html = !arguments.no_html;
  report.map_picture.color_blind_safe = arguments.color_blind;
  const MapFigures figures = figuresOf(document);
  writeReport(record, document, figures, results.path(), report);
  if (!arguments.simplemap.empty()) writeSimpleMap(result.key_frames, arguments.simplemap);
  results.commit();

  if (arguments.json)
    std::printf("%s\n", toJson(record, figures).c_str());
  else
    printSummary(record, figures, folder, report.html);
}

}  // namespace

void addMapCommand(CLI::App& program) {
  auto arguments = std::make_shared<MapArguments>();
  CLI::App* command = program.add_subcommand("map", "Build a semantic map from rawlogs");
  command
      ->add_option("LOG", arguments->logs, "Rawlogs or simplemaps (.gz or not), one after another")
      ->required();
  command
      ->add_option("-c,--config", arguments->config, "Ini file with a section [MappingApplication]")
      ->required();
  command
      ->add_option("-o,--output", arguments->output,
                   "Folder for map.csom, run.json, report.html and pictures; created if missing")
      ->required();
  command->add_option("--poses", arguments->poses,
                      "odometry | robot-pose[:LABEL] | tum:FILE | kitti:FILE | simplemap:FILE | "
                      "icp[:LABEL], which registers the 3-D scans and writes trajectory.tum "
                      "(default: the robot poses of the log, else its odometry; a simplemap has "
                      "poses of its own)");
  command->add_option(
      "--threads", arguments->threads,
      "Threads, 0 = all processors; does not change the map (default: as in the ini)");
  command->add_option(
      "--label-cache", arguments->label_cache,
      "Folder in which what networks say about images is kept, so that the next run "
      "needs no network (default: as in the ini)");
  command->add_option("--write-simplemap", arguments->simplemap,
                      "Also write the observations with their poses as a simplemap, of which "
                      "observations2map makes the same map");
  command->add_flag("--no-deskew", arguments->no_deskew,
                    "Take Velodyne scans as they are, although the robot moves while the sensor "
                    "turns");
  command
      ->add_flag_callback(
          "--print-config",
          [] {
            std::fputs(defaultIni().c_str(), stdout);
            throw CLI::Success();
          },
          "Print an ini with every key, its default and what it means, and do nothing else")
      ->trigger_on_parse();
  command->add_flag("--no-html", arguments->no_html, "Write no report.html");
  command->add_flag("--color-blind", arguments->color_blind,
                    "Pictures in colours that people with colour-blind eyes tell apart, instead of "
                    "those of the label set");
  command->add_flag("--json", arguments->json, "Print the run record as JSON instead of a summary");
  command->footer(
      "Examples:\n"
      "  csom map drive.rawlog -c config/campus.ini -o out\n"
      "  csom map a.rawlog b.rawlog.gz -c my.ini -o out --poses tum:trajectory.txt\n"
      "  csom map slam.simplemap -c my.ini -o out --threads 0 --json");
  command->callback([arguments] { runMap(*arguments); });
}

}  // namespace csom
