// SPDX-License-Identifier: BSD-3-Clause
// csom export: the voxels of a map for other programs.
#include <csom/io/Exporters.h>
#include <csom/io/MapFile.h>

#include <cstdio>
#include <map>
#include <memory>
#include <string>

#include "Arguments.h"
#include "OutputPaths.h"
#include "commands.h"

namespace csom {

namespace {

struct ExportArguments {
  std::string file;
  std::string output;
  ExportFormat format = ExportFormat::Ply;
  bool all = false;
};

void runExport(const ExportArguments& arguments) {
  requireSeparateOutputs({arguments.output}, {arguments.file});
  const MapDocument document = loadMap(arguments.file);
  const std::size_t voxels =
      exportMap(document.map, document.labels, arguments.format,
                arguments.all ? ExportVoxels::Known : ExportVoxels::Occupied, arguments.output);
  // Not to standard output: -o may be /dev/stdout.
  std::fprintf(stderr, "%s: %zu voxels\n", arguments.output.c_str(), voxels);
}

}  // namespace

void addExportCommand(CLI::App& program) {
  const std::map<std::string, ExportFormat> formats{
      {"ply", ExportFormat::Ply}, {"pcd", ExportFormat::Pcd}, {"csv", ExportFormat::Csv}};
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command =
      program.add_subcommand("export", "Write the voxels of a map as a PLY, PCD or CSV file");
  command->add_option("MAP", arguments->file, "map file (.csom)")->required();
  command->add_option("--to", arguments->format, "ply, pcd or csv")
      ->required()
      ->transform(oneOf(formats))
      ->type_name("FORMAT");
  command->add_option("-o,--output", arguments->output, "file to write, or /dev/stdout")
      ->required();
  command->add_flag("--all", arguments->all, "free voxels as well");
  command->footer(
      "Writes the occupied voxels of a map, one point or line each: the voxel's centre in metres,\n"
      "and its most likely class. ply and csv have that class's probability and variance too; "
      "csv's\n"
      "columns are x,y,z,class_id,class_name,probability,variance,evidence. pcd has x y z rgb "
      "label,\n"
      "in single precision, as PCL reads them.\n\n"
      "Examples:\n"
      "  csom export out/map.csom --to ply -o map.ply      # for MeshLab or CloudCompare\n"
      "  csom export out/map.csom --to pcd -o map.pcd      # for PCL, pcl_viewer\n"
      "  csom export out/map.csom --to csv --all -o map.csv");
  command->callback([arguments] { runExport(*arguments); });
}

}  // namespace csom
