// SPDX-License-Identifier: BSD-3-Clause
// csom merge: the sum of maps.
#include <csom/core/Error.h>
#include <csom/io/MapFile.h>

#include <cstdio>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "commands.h"

namespace csom {

namespace {

struct MergeArguments {
  std::vector<std::string> inputs;
  std::string output;
};

/// Adds `part` to `sum`. Throws FileError if they do not fit.
void addMap(MapDocument& sum, MapDocument part, const std::string& first_file,
            const std::string& file) {
  if (part.labels != sum.labels)
    throw FileError(file, "its label set '" + part.labels.name() + "' is not that of " +
                              first_file + ", '" + sum.labels.name() +
                              "' (names, colors, ids and raw ids must all be equal)");
  try {
    sum.map.merge(part.map);
  } catch (const std::invalid_argument& error) {
    throw FileError(file, std::string(error.what()) + " of " + first_file);
  }
  sum.scans.insert(sum.scans.end(), part.scans.begin(), part.scans.end());
}

void runMerge(const MergeArguments& arguments) {
  const std::string& first_file = arguments.inputs.front();
  MapDocument sum = loadMap(first_file);
  std::string sources = first_file;
  for (std::size_t i = 1; i < arguments.inputs.size(); ++i) {
    addMap(sum, loadMap(arguments.inputs[i]), first_file, arguments.inputs[i]);
    sources += " " + arguments.inputs[i];
  }
  // What the first map says of its own making is not true of the sum.
  sum.meta = {{"created_by", "csom " CSOM_VERSION}, {"merged_from", sources}};
  saveMap(sum, arguments.output);
  std::printf("%s: %zu maps, %zu scans, %zu known voxels, digest %s\n", arguments.output.c_str(),
              arguments.inputs.size(), sum.scans.size(), sum.map.knownVoxelCount(),
              mapDigest(sum.map).c_str());
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
      "and prior, and lie in the same frame.\n\n"
      "Example:\n"
      "  csom merge monday/map.csom tuesday/map.csom -o both.csom");
  command->callback([arguments] { runMerge(*arguments); });
}

}  // namespace csom
