// SPDX-License-Identifier: BSD-3-Clause
// The command line of `csom map`.
#include "MapArguments.h"

#include <csom/core/Error.h>
#include <csom/maps/DefaultIni.h>

#include <cstdio>
#include <filesystem>

namespace csom {

void addMapOptions(CLI::App& command, MapArguments& arguments) {
  command.add_option("LOG", arguments.logs,
                     "Rawlogs or simplemaps (.gz or not), one after another");
  command.add_option("-c,--config", arguments.config,
                     "Ini file with a section [MappingApplication]");
  command.add_option("-o,--output", arguments.output,
                     "Folder for map.csom, run.json, report.html and pictures; created if missing");
  command.add_option("--poses", arguments.poses,
                     "odometry | robot-pose[:LABEL] | tum:FILE | kitti:FILE | simplemap:FILE | "
                     "icp[:LABEL], which registers the 3-D scans and writes trajectory.tum "
                     "(default: the robot poses of the log, else its odometry; a simplemap has "
                     "poses of its own)");
  command.add_option(
      "--threads", arguments.threads,
      "Threads, 0 = all processors; does not change the map (default: as in the ini)");
  command.add_option("--label-cache", arguments.label_cache,
                     "Folder in which what networks say about images is kept, so that the next run "
                     "needs no network (default: as in the ini)");
  command.add_option("--write-simplemap", arguments.simplemap,
                     "Also write the observations with their poses as a simplemap, of which "
                     "observations2map makes the same map");
  command
      .add_option(
          "--resume", arguments.resume,
          "Go on with the run that was to write into this folder and was stopped, killed or "
          "ran out of disk; it takes logs and options from there, but name --write-simplemap and "
          "--label-cache again: nothing is written elsewhere because a file says so")
      ->type_name("FOLDER");
  command
      .add_option("--checkpoint", arguments.checkpoint,
                  "Save what is done every so many seconds; 0 = after every entry of the log")
      ->type_name("SECONDS")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e6));
  command
      .add_option("--max-memory", arguments.max_memory,
                  "Most memory for voxels (500MB, 2GB): what is more goes to the disk, for maps "
                  "larger than memory; does not change the map")
      ->type_name("BYTES")
      ->transform(CLI::AsSizeValue(true));
  command.add_flag("--no-deskew", arguments.no_deskew,
                   "Take Velodyne scans as they are, although the robot moves while the sensor "
                   "turns");
  command
      .add_flag_callback(
          "--print-config",
          [] {
            std::fputs(defaultIni().c_str(), stdout);
            throw CLI::Success();
          },
          "Print an ini with every key, its default and what it means, and do nothing else")
      ->trigger_on_parse();
  command.add_flag("--no-html", arguments.no_html, "Write no report.html");
  command.add_flag("--color-blind", arguments.color_blind,
                   "Pictures in colours that people with colour-blind eyes tell apart, instead of "
                   "those of the label set");
  command.add_flag("--json", arguments.json, "Print the run record as JSON instead of a summary");
}

void check(const MapArguments& arguments) {
  constexpr std::uint64_t kMinMemory = 1000000;
  if (arguments.max_memory && *arguments.max_memory < kMinMemory)
    throw ConfigError("--max-memory " + std::to_string(*arguments.max_memory) +
                      " is less than 1 MB; write the unit too, as in 500MB");
  if (arguments.resume.empty()) {
    if (arguments.logs.empty()) throw ConfigError("LOG is required: name a rawlog or a simplemap");
    if (arguments.config.empty()) throw ConfigError("--config is required: name an ini file");
    if (arguments.output.empty()) throw ConfigError("--output is empty: name a folder");
    return;
  }
  if (!arguments.logs.empty() || !arguments.config.empty() || !arguments.output.empty() ||
      !arguments.poses.empty() || arguments.threads || arguments.no_deskew)
    throw ConfigError(
        "--resume takes logs, configuration, poses and threads from the run that it goes on with; "
        "beside it there may be --write-simplemap, --label-cache, --checkpoint, --max-memory, "
        "--no-html, --color-blind and --json");
}

MappingRequest makeRequest(const MapArguments& arguments) {
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

std::map<std::string, std::string> makeNotes(const MapArguments& arguments) {
  std::map<std::string, std::string> notes;
  if (!arguments.simplemap.empty())
    notes["simplemap"] = std::filesystem::absolute(arguments.simplemap).string();
  if (arguments.no_html) notes["no_html"] = "on";
  if (arguments.color_blind) notes["color_blind"] = "on";
  return notes;
}

void applyNotes(const MapStore::State& state, MapArguments& arguments) {
  const auto simplemap = state.find("note.simplemap");
  if (simplemap != state.end() && arguments.simplemap.empty())
    throw ConfigError("that run was to write a simplemap, '" + simplemap->second +
                      "'; say so again with --write-simplemap FILE");
  if (simplemap == state.end() && !arguments.simplemap.empty())
    throw ConfigError("--write-simplemap: the run that is gone on with did not write one");
  arguments.no_html |= state.count("note.no_html") > 0;
  arguments.color_blind |= state.count("note.color_blind") > 0;
}

}  // namespace csom
