// SPDX-License-Identifier: BSD-3-Clause
// csom merge: the sum of maps.
#include <csom/core/Error.h>
#include <csom/io/MapFile.h>
#include <csom/io/TextParser.h>

#include <cstdio>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"

namespace csom {

namespace {

struct MergeArguments {
  std::vector<std::string> inputs;
  std::string output;
};

/// A log whose scans are in a map.
struct LogOfMap {
  std::string file;   ///< as the run that read it was given it
  std::string bytes;  ///< its size, as a text
  std::string hash;
};

/// What a map says of the logs that it was made of, also through merges; nothing for maps that
/// other programs have made.
std::vector<LogOfMap> logsOf(const MapDocument& document) {
  const auto text = [&](const std::string& key) {
    const auto found = document.meta.find(key);
    return found == document.meta.end() ? std::string() : found->second;
  };
  std::vector<LogOfMap> logs;
  for (std::size_t number = 1;; ++number) {
    const std::string key = "input." + std::to_string(number);
    const LogOfMap log{text(key + ".file"), text(key + ".bytes"), text(key + ".xxh3")};
    if (log.file.empty() || log.hash.empty()) return logs;
    // Older maps do not say what an input is, but list the logs once more.
    const std::string kind = text(key + ".kind");
    if (kind == "log" || (kind.empty() && text("rawlog").find(log.file) != std::string::npos))
      logs.push_back(log);
  }
}

/// The sum of maps, and what is in it already.
class Merge {
 public:
  explicit Merge(const std::string& first_file)
      : first_file_(first_file), sum_(loadMap(first_file)) {
    remember(first_file, sum_);
  }

  /// Throws FileError if the maps do not fit, or if something would count twice.
  void add(const std::string& file) {
    const MapDocument part = loadMap(file);
    if (part.labels != sum_.labels)
      throw FileError(file, "its label set '" + part.labels.name() + "' is not that of " +
                                first_file_ + ", '" + sum_.labels.name() +
                                "' (names, colors, ids and raw ids must all be equal)");
    remember(file, part);
    try {
      sum_.map.merge(part.map);
    } catch (const std::invalid_argument& error) {
      throw FileError(file, std::string(error.what()) + " of " + first_file_);
    }
    sum_.scans.insert(sum_.scans.end(), part.scans.begin(), part.scans.end());
  }

  /// What the first map says of its own making is not true of the sum.
  MapDocument finish() && {
    sum_.meta = {{"created_by", "csom " CSOM_VERSION}, {"merged_from", detail::joined(files_)}};
    std::size_t number = 0;
    for (const auto& [hash, log] : log_of_hash_) {
      const std::string key = "input." + std::to_string(++number);
      sum_.meta[key + ".kind"] = "log";
      sum_.meta[key + ".file"] = log.file;
      sum_.meta[key + ".bytes"] = log.bytes;
      sum_.meta[key + ".xxh3"] = hash;
    }
    return std::move(sum_);
  }

 private:
  void remember(const std::string& file, const MapDocument& part) {
    const std::string digest = mapDigest(part.map);
    const auto [same, is_new] = file_of_digest_.emplace(digest, file);
    if (!is_new && !part.map.empty())
      throw FileError(file, "is the same map as " + same->second +
                                ": what they have seen would count twice; name each map once");
    for (const LogOfMap& log : logsOf(part)) {
      const auto [other, is_new_log] = log_of_hash_.emplace(log.hash, log);
      if (!is_new_log)
        throw FileError(file, "holds the scans of " + log.file + ", which are in " +
                                  file_of_log_.at(log.hash) +
                                  " already (the logs have the same content): they would count "
                                  "twice; leave one of the maps out");
      file_of_log_[log.hash] = file;
    }
    files_.push_back(file);
  }

  std::string first_file_;
  MapDocument sum_;
  std::vector<std::string> files_;
  std::map<std::string, std::string> file_of_digest_;
  std::map<std::string, LogOfMap> log_of_hash_;
  std::map<std::string, std::string> file_of_log_;  ///< map by hash of a log
};

void runMerge(const MergeArguments& arguments) {
  Merge merge(arguments.inputs.front());
  for (std::size_t i = 1; i < arguments.inputs.size(); ++i) merge.add(arguments.inputs[i]);
  const MapDocument sum = std::move(merge).finish();
  saveMap(sum, arguments.output);
  std::printf("%s: %zu maps, %zu scans, %zu known voxels, digest %s\n",
              detail::printable(arguments.output).c_str(), arguments.inputs.size(),
              sum.scans.size(), sum.map.knownVoxelCount(), mapDigest(sum.map).c_str());
}

}  // namespace

void addMergeCommand(CLI::App& program) {
  auto arguments = std::make_shared<MergeArguments>();
  CLI::App* command = program.add_subcommand("merge", "Add maps of parts into one");
  command->add_option("MAPS", arguments->inputs, "map files (.csom), two or more")
      ->required()
      ->expected(2, CLI::detail::expected_max_vector_size);
  command->add_option("-o,--output", arguments->output, "map file to write")->required();
  command->footer(
      "Adds maps into one, exactly: the result is the map that one run over all scans would have\n"
      "made, in whatever order the maps are given. They must have the same resolution, label set\n"
      "and prior, and lie in the same frame. No log may be in two of them: its scans would count\n"
      "twice.\n\n"
      "Example:\n"
      "  csom merge monday/map.csom tuesday/map.csom -o both.csom");
  command->callback([arguments] { runMerge(*arguments); });
}

}  // namespace csom
