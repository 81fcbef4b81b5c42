// SPDX-License-Identifier: BSD-3-Clause
// The command line of `csom map`.
#pragma once

#include <csom/io/MapStore.h>
#include <csom/rawlog/MappingRun.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace csom {

struct MapArguments {
  std::vector<std::string> logs;
  std::string config;
  std::string output;
  std::string poses;
  std::optional<int> threads;
  std::string label_cache;
  std::string simplemap;
  std::string resume;  ///< the folder of an unfinished run
  double checkpoint = 10;
  std::optional<std::uint64_t> max_memory;
  bool no_deskew = false;
  bool no_html = false;
  bool color_blind = false;
  bool json = false;
};

/// Declares the options of the command.
void addMapOptions(CLI::App& command, MapArguments& arguments);
/// Throws ConfigError for options that do not go together.
void check(const MapArguments& arguments);

MappingRequest makeRequest(const MapArguments& arguments);

/// What a resumed run must know of the arguments beside the request, and back.
std::map<std::string, std::string> makeNotes(const MapArguments& arguments);
/// Throws ConfigError if the run wrote a file outside of its folder that is not named again.
void applyNotes(const MapStore::State& state, MapArguments& arguments);

}  // namespace csom
