// SPDX-License-Identifier: BSD-3-Clause
// csom map: rawlogs become a map and a report.
#include <csom/core/Error.h>
#include <csom/io/MapFile.h>
#include <csom/io/MapStore.h>
#include <csom/io/OutputFile.h>
#include <csom/io/TextParser.h>
#include <csom/rawlog/MappingRun.h>
#include <csom/rawlog/RawlogWriter.h>
#include <csom/report/Format.h>
#include <csom/report/MapFigures.h>
#include <csom/report/Report.h>
#include <csom/report/RunRecord.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <utility>

#include "CommandLine.h"
#include "MapArguments.h"
#include "MapRecord.h"
#include "MappingStatus.h"
#include "OutputFolder.h"
#include "OutputPaths.h"
#include "Progress.h"
#include "StopSignal.h"
#include "commands.h"

namespace csom {
namespace {

constexpr char kUnfinished[] = "unfinished.csom";
/// Left to the rest of the program when a run stops before memory is used up.
constexpr std::size_t kMemoryReserve = 256'000'000;
/// A part of a map that is larger than memory, while its figures are counted.
constexpr std::size_t kPartBytes = 32'000'000;

MappingResult mapWithProgress(const MappingRequest& request, const CheckpointRequest& checkpoints) {
  Progress progress("mapping");
  return mapLogs(
      request,
      [&](const MappingProgress& now) {
        progress.update(now.entries_done, now.entries,
                        [&](double seconds) { return mappingStatus(now, seconds); });
      },
      checkpoints);
}

MapDocument makeDocument(const RunRecord& record, const MappingResult& result) {
  MapDocument document = result.map->document();
  for (const auto& [key, value] : result.store->meta()) document.meta.emplace(key, value);
  for (const char* key : {"state", "digest", "checksum"}) document.meta.erase(key);
  document.meta["poses"] = record.pose_source;
  return document;
}

/// The map in figures, with all voxels in `document` as far as they fit into `max_memory`.
MapFigures computeFigures(MapDocument& document, const MappingResult& result,
                          std::optional<std::uint64_t> max_memory) {
  if (result.voxels_in_memory) return computeFigures(document);
  MapFiguresSum sum(document.labels, result.store->options());
  result.store->forEachPart(std::min<std::size_t>(kPartBytes, max_memory.value_or(kPartBytes)),
                            [&](const SemanticMap& part) { sum.add(part); });
  MapFigures figures = sum.figures(result.store->digest());
  if (figures.memory_bytes <= max_memory.value_or(0)) document.map = result.store->loadVoxels();
  return figures;
}

void printSummary(const RunRecord& record, const MapFigures& figures, const OutputFolder& folder,
                  bool html) {
  std::printf("scans     %s with %s, poses: %s\n", formatCount(record.scans.size()).c_str(),
              formatCount(pointsRead(record), "point").c_str(),
              detail::printable(record.pose_source).c_str());
  if (pointsRejected(record) > 0)
    std::printf("rejected  %s points (reasons in run.json)\n",
                formatCount(pointsRejected(record)).c_str());
  if (record.labels.keptUnlabelled() > 0)
    std::printf("no label  %s in the map as unlabelled\n",
                formatCount(record.labels.keptUnlabelled(), "point").c_str());
  if (record.no_returns > 0)
    std::printf("no return %s hit nothing\n", formatCount(record.no_returns, "beam").c_str());
  if (const std::string images = describeImages(record.images); !images.empty())
    std::printf("beams     %s\n", images.c_str());
  if (const auto& cameras = record.camera_labels)
    std::printf(
        "cameras   %s labelled; %s outside of their view, %s hidden or at an edge%s\n",
        formatCount(cameras->points.labelled, "point").c_str(),
        formatCount(cameras->points.outside_view).c_str(),
        formatCount(cameras->points.hidden + cameras->points.at_edge).c_str(),
        cameras->points.kept_unlabelled > 0 ? ": in the map as unlabelled" : ": not in the map");
  for (const RefusedObservations& refused : record.refused)
    std::printf("unused    %s %s: %s\n", formatCount(refused.count).c_str(),
                detail::printable(refused.observation_class).c_str(),
                detail::printable(refused.reason).c_str());
  std::printf("map       %s voxels known, %s occupied, %.1f MB in memory: %s\n",
              formatCount(figures.known_voxels).c_str(),
              formatCount(figures.occupied_voxels).c_str(),
              static_cast<double>(figures.memory_bytes) / 1e6,
              detail::printable(folder.file("map.csom")).c_str());
  std::printf("time      %.2f s\n", record.wall_seconds);
  std::printf("report    %s\n",
              detail::printable(folder.file(html ? "report.html" : "run.json")).c_str());
}

void writeSimpleMap(const mrpt::maps::CSimpleMap& key_frames, const std::string& file) {
  RawlogWriter writer(file);
  writer.write(key_frames);
  writer.commit();
}

/// Names, before anything is done, all that the command may write.
OutputFolder outputFolder(const MapArguments& arguments, const MappingRequest& request) {
  std::vector<std::string> inputs = request.logs;
  inputs.push_back(request.config_file);
  if (request.poses && request.poses->takesFile()) inputs.push_back(request.poses->argument);
  std::vector<std::string> names = reportFiles();
  names.push_back("map.csom");
  names.push_back("trajectory.tum");
  OutputFolder folder(arguments.output, names);
  std::vector<std::string> outputs{folder.file(kUnfinished)};
  for (const std::string& name : folder.results()) outputs.push_back(folder.file(name));
  if (!arguments.simplemap.empty()) outputs.push_back(arguments.simplemap);
  requireSeparateOutputs(outputs, inputs);
  if (!arguments.simplemap.empty()) OutputFile(arguments.simplemap);  // can it be written?
  return folder;
}

/// How to go on, if there is something to go on with.
std::string resumeHint(const std::string& unfinished, const std::string& folder) {
  std::error_code error;
  if (!std::filesystem::exists(unfinished, error)) return "";
  return "; go on with: csom map --resume " + shellQuoted(folder);
}

MappingResult mapOrSayHowToGoOn(const MappingRequest& request, const CheckpointRequest& checkpoints,
                                const std::string& folder) {
  if (!checkpoints.resume && std::filesystem::exists(checkpoints.file)) {
    MapStore::open(checkpoints.file);  // says if somebody is writing it
    throw FileError(checkpoints.file, "is the map of a run that has not been finished" +
                                          resumeHint(checkpoints.file, folder) +
                                          ", or remove it to begin anew");
  }
  try {
    return mapWithProgress(request, checkpoints);
  } catch (const ConfigError&) {
    throw;  // before there was anything to go on with
  } catch (Error& error) {
    error.append(resumeHint(checkpoints.file, folder));
    throw;
  } catch (const std::bad_alloc&) {
    throw Error("memory is used up" + resumeHint(checkpoints.file, folder));
  } catch (const std::exception& error) {
    throw Error(error.what() + resumeHint(checkpoints.file, folder));
  }
}

CheckpointRequest checkpointsOf(const MapArguments& arguments, const MappingRequest& request,
                                const OutputFolder& folder, const StopSignal& signal) {
  CheckpointRequest checkpoints;
  checkpoints.file = folder.file(kUnfinished);
  checkpoints.resume = !arguments.resume.empty();
  checkpoints.seconds = arguments.checkpoint;
  if (arguments.max_memory) checkpoints.max_memory = *arguments.max_memory;
  checkpoints.meta = {{"created_by", "csom " CSOM_VERSION},
                      {"command", commandLine()},
                      {"rawlog", detail::joined(request.logs)}};
  checkpoints.notes = makeNotes(arguments);
  checkpoints.stop = [&signal] { return signal.received(); };
  checkpoints.memory_shortage = [] { return memoryShortage(kMemoryReserve); };
  return checkpoints;
}

/// The request of the run that is to be gone on with.
MappingRequest resumedRequest(MapArguments& arguments) {
  arguments.output = arguments.resume;
  const std::string file = (std::filesystem::path(arguments.resume) / kUnfinished).string();
  if (!std::filesystem::exists(file))
    throw FileError(arguments.resume, std::string("has no ") + kUnfinished +
                                          ": no run was stopped there that could go on");
  const MapStore::State state = readState(file);
  applyNotes(state, arguments);
  MappingRequest request = readRequest(state, file);
  request.label_cache = arguments.label_cache;  // none if that is empty
  return request;
}

void runMap(MapArguments arguments) {
  check(arguments);
  const StopSignal signal;
  const MappingRequest request =
      arguments.resume.empty() ? makeRequest(arguments) : resumedRequest(arguments);
  const OutputFolder folder = outputFolder(arguments, request);
  StagedResults results(folder);

  const auto start = std::chrono::steady_clock::now();
  MappingResult result = mapOrSayHowToGoOn(
      request, checkpointsOf(arguments, request, folder, signal), arguments.output);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;

  RunRecord record = makeRecord(request, result, elapsed.count());
  MapDocument document = makeDocument(record, result);
  ReportOptions report;
  report.html = !arguments.no_html;
  report.map_picture.color_blind_safe = arguments.color_blind;
  const MapFigures figures = computeFigures(document, result, arguments.max_memory);
  if (!result.voxels_in_memory && document.map.empty()) {
    report.html = report.png = false;
    record.warnings.push_back(
        "the map takes " + formatBytes(figures.memory_bytes) +
        ", more than --max-memory: no pictures and no report.html; csom report makes them where "
        "there is more memory");
  }
  for (const std::string& warning : record.warnings)
    std::fprintf(stderr, "csom: warning: %s\n", detail::printable(warning).c_str());
  try {
    result.store->writeFinished(results.file("map.csom"), document.meta);
    if (result.registration) writeTumTrajectory(result.trajectory, results.file("trajectory.tum"));
    writeReport(record, document, figures, results.path(), report);
    if (!arguments.simplemap.empty()) writeSimpleMap(result.key_frames, arguments.simplemap);
    results.commit();
  } catch (const std::exception& error) {
    throw std::runtime_error(error.what() + resumeHint(folder.file(kUnfinished), arguments.output));
  }
  // Only now nobody needs it any more.
  MapStore::remove(std::move(result.store));

  if (arguments.json)
    std::printf("%s\n", toJson(record, figures).c_str());
  else
    printSummary(record, figures, folder, report.html);
}

}  // namespace

void addMapCommand(CLI::App& program) {
  auto arguments = std::make_shared<MapArguments>();
  CLI::App* command = program.add_subcommand("map", "Build a semantic map from rawlogs");
  addMapOptions(*command, *arguments);
  command->footer(
      "While it runs the map grows in unfinished.csom of the output folder, which csom info and "
      "all\n"
      "other commands read. Ctrl-C finishes the scan at hand and saves; after that, after a crash "
      "or a\n"
      "full disk, --resume goes on and makes the same map, bit for bit.\n\n"
      "Examples:\n"
      "  csom map drive.rawlog -c config/campus.ini -o out\n"
      "  csom map a.rawlog b.rawlog.gz -c my.ini -o out --poses tum:trajectory.txt\n"
      "  csom map slam.simplemap -c my.ini -o out --threads 0 --json\n"
      "  csom map --resume out\n"
      "  csom map city.rawlog -c my.ini -o out --max-memory 2GB");
  command->callback([arguments] { runMap(*arguments); });
}

}  // namespace csom
