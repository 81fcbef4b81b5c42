// SPDX-License-Identifier: BSD-3-Clause
// csom repair: what is intact of a damaged map.
#include <csom/core/Error.h>
#include <csom/io/MapRepair.h>
#include <csom/io/TextParser.h>

#include <cstdio>
#include <memory>
#include <string>

#include "OutputPaths.h"
#include "commands.h"

namespace csom {

namespace {

struct RepairArguments {
  std::string input;
  std::string output;
};

void runRepair(const RepairArguments& arguments) {
  requireSeparateOutputs({arguments.output}, {arguments.input});
  MapRepair repair = recoverMap(arguments.input);
  repair.document.meta["repaired_from"] = arguments.input;
  for (std::size_t i = 0; i < repair.losses.size(); ++i)
    repair.document.meta["lost_" + std::to_string(i + 1)] = repair.losses[i];
  saveMap(repair.document, arguments.output);
  const MapDocument& document = repair.document;
  std::printf("%s: %zu chunks, %zu known voxels, %zu scans, digest %s\n",
              detail::printable(arguments.output).c_str(), document.map.chunks().chunkCount(),
              document.map.knownVoxelCount(), document.scans.size(),
              mapDigest(document.map).c_str());
  for (const std::string& loss : repair.losses)
    std::printf("lost: %s\n", detail::printable(loss).c_str());
  if (!repair.lost_chunks) std::printf("no voxel is lost\n");
}

}  // namespace

void addRepairCommand(CLI::App& program) {
  auto arguments = std::make_shared<RepairArguments>();
  CLI::App* command = program.add_subcommand("repair", "Save what is intact of a damaged map");
  command->add_option("IN", arguments->input, "map file (.csom) that is damaged")->required();
  command->add_option("OUT", arguments->output, "map file to write")->required();
  command->footer(
      "Finds every chunk and every record of a scan whose hash is right, wherever it lies in the\n"
      "file, even if the database cannot be opened any more, and says what is lost. IN is not\n"
      "changed. What is missing can be mapped again and added with csom merge.\n\n"
      "Example:\n"
      "  csom repair out/map.csom rescued.csom");
  command->callback([arguments] { runRepair(*arguments); });
}

}  // namespace csom
