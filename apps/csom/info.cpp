// SPDX-License-Identifier: BSD-3-Clause
// csom info: what a map file holds.
#include <csom/core/Error.h>
#include <csom/io/MapFile.h>
#include <csom/io/MapRepair.h>
#include <csom/io/TextParser.h>
#include <csom/report/ClassesJson.h>
#include <csom/report/MapFigures.h>

#include <cstdio>
#include <map>
#include <memory>
#include <type_traits>

#include "Output.h"
#include "commands.h"

namespace csom {

namespace {

struct InfoArguments {
  std::string file;
  bool json = false;
  bool verify = false;
};

/// The scans of a map in sum.
struct ScanSummary {
  std::map<std::string, std::size_t> by_class;
  ScanReport total;
};

ScanSummary summarise(const std::vector<ScanRecord>& scans) {
  ScanSummary summary;
  for (const ScanRecord& scan : scans) {
    ++summary.by_class[scan.observation_class];
    summary.total += scan.report;
  }
  return summary;
}

Json scansToJson(const MapDocument& document) {
  const ScanSummary summary = summarise(document.scans);
  Json json;
  json["count"] = document.scans.size();
  json["by_observation_class"] = summary.by_class;
  json["points"] = summary.total.points;
  Json rejected = Json::object();
  for (std::size_t i = 0; i < kRejectReasons; ++i)
    rejected[toString(static_cast<RejectReason>(i))] = summary.total.rejected[i];
  json["rejected"] = rejected;
  return json;
}

void printAsJson(const MapDocument& document, const MapFigures& figures) {
  Json json;
  json["digest"] = figures.digest;
  json["resolution_m"] = figures.resolution;
  json["label_set"] = document.labels.name();
  json["known_voxels"] = figures.known_voxels;
  json["occupied_voxels"] = figures.occupied_voxels;
  json["free_voxels"] = figures.free_voxels;
  json["chunks"] = figures.chunks;
  json["memory_bytes"] = figures.memory_bytes;
  json["bounding_box_m"] = nullptr;
  if (!figures.bounds.isEmpty())
    json["bounding_box_m"] = {{"min", toJson(Eigen::Vector3d(figures.bounds.min()))},
                              {"max", toJson(Eigen::Vector3d(figures.bounds.max()))}};
  json["scans"] = scansToJson(document);
  json["classes"] = classesToJson(figures.classes);
  Json options = Json::object();
  visitOptions(document.map.options(), [&](const OptionInfo& option, const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_enum_v<Value>)
      options[option.key] = toString(value);
    else
      options[option.key] = value;
  });
  json["options"] = options;
  json["meta"] = document.meta;
  printJson(json);
}

void printScans(const MapDocument& document) {
  const ScanSummary summary = summarise(document.scans);
  std::printf("\nscans           %zu, %zu points\n", document.scans.size(), summary.total.points);
  for (const auto& [name, count] : summary.by_class)
    std::printf("  %-30s %zu\n", detail::printable(name).c_str(), count);
  for (std::size_t i = 0; i < kRejectReasons; ++i) {
    if (summary.total.rejected[i] != 0)
      std::printf("  points rejected, %-13s %zu\n", toString(static_cast<RejectReason>(i)),
                  summary.total.rejected[i]);
  }
}

void printClasses(const MapDocument& document, const MapFigures& figures) {
  std::printf("\nclasses         label set %s\n",
              detail::printable(document.labels.name()).c_str());
  std::printf("  %3s  %-20s %10s %12s %7s %12s\n", "id", "name", "voxels", "volume [m3]", "share",
              "probability");
  for (const ClassFigures& c : figures.classes) {
    if (c.voxels == 0) continue;
    std::printf("  %3d  %-20s %10zu %12.2f %6.1f%% %12.3f\n", c.id,
                detail::printable(c.name).c_str(), c.voxels, c.volume, 100 * c.share,
                c.mean_probability);
  }
}

void printAsText(const MapDocument& document, const MapFigures& figures) {
  if (document.meta.count("state") > 0)
    std::printf(
        "state           unfinished: this is what its run had saved; csom map --resume FOLDER goes "
        "on\n");
  std::printf("digest          %s\n", figures.digest.c_str());
  std::printf("resolution      %s m\n", toText(figures.resolution).c_str());
  std::printf("known voxels    %zu: %zu occupied, %zu free\n", figures.known_voxels,
              figures.occupied_voxels, figures.free_voxels);
  if (figures.bounds.isEmpty())
    std::printf("bounding box    none, the map is empty\n");
  else
    std::printf("bounding box    from %s to %s m\n", toText(figures.bounds.min()).c_str(),
                toText(figures.bounds.max()).c_str());
  std::printf("memory          %.2f MB in %zu chunks\n",
              static_cast<double>(figures.memory_bytes) / 1e6, figures.chunks);
  printScans(document);
  printClasses(document, figures);

  std::printf("\noptions\n");
  visitOptions(document.map.options(), [](const OptionInfo& option, const auto& value) {
    std::printf("  %-24s %s %s\n", option.key, toString(value).c_str(), option.unit);
  });
  if (!document.meta.empty()) std::printf("\nmeta\n");
  for (const auto& [key, value] : document.meta)
    std::printf("  %-24s %s\n", detail::printable(key).c_str(), detail::printable(value).c_str());
}

Json verificationToJson(const MapVerification& found) {
  Json json;
  json["intact"] = found.faults.empty();
  json["finished"] = found.finished;
  json["chunks"] = found.chunks;
  json["scans"] = found.scans;
  json["digest"] = found.digest;
  json["faults"] = found.faults;
  return json;
}

void runVerify(const InfoArguments& arguments) {
  const MapVerification found = verifyMap(arguments.file);
  if (arguments.json)
    printJson(verificationToJson(found));
  else if (found.faults.empty())
    std::printf("%s: intact%s, %zu chunks, %zu scans, digest %s\n",
                detail::printable(arguments.file).c_str(), found.finished ? "" : ", unfinished",
                found.chunks, found.scans, found.digest.c_str());
  for (const std::string& fault : found.faults)
    std::fprintf(stderr, "csom: %s\n", detail::printable(fault).c_str());
  if (!found.faults.empty())
    throw FileError(arguments.file, "is damaged; 'csom repair' saves " +
                                        std::to_string(found.chunks) + " intact chunks of it");
}

void runInfo(const InfoArguments& arguments) {
  if (arguments.verify) {
    runVerify(arguments);
    return;
  }
  const MapDocument document = loadMap(arguments.file);
  const MapFigures figures = computeFigures(document);
  if (arguments.json)
    printAsJson(document, figures);
  else
    printAsText(document, figures);
}

}  // namespace

void addInfoCommand(CLI::App& program) {
  auto arguments = std::make_shared<InfoArguments>();
  CLI::App* command = program.add_subcommand("info", "Print what a map holds");
  command->add_option("MAP", arguments->file, "map file (.csom)")->required();
  command->add_flag("--json", arguments->json, "print JSON");
  command->add_flag("--verify", arguments->verify,
                    "check every byte instead, a chunk at a time, and list all that is wrong");
  command->footer(
      "Prints what a map holds: size, extent, classes, scans, options and where it comes from.\n"
      "All voxels are checked on the way; a damaged file is an error. --verify finds damage "
      "anywhere\n"
      "in the file, in maps larger than memory too; exit code 1 if there is any.\n\n"
      "Examples:\n"
      "  csom info out/map.csom --verify\n"
      "  csom info out/map.csom\n"
      "  csom info out/map.csom --json | jq '.classes[] | select(.voxels > 0) | .name'");
  command->callback([arguments] { runInfo(*arguments); });
}

}  // namespace csom
