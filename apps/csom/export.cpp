// SPDX-License-Identifier: BSD-3-Clause
// csom export: a map in the formats of other programs.
#include <csom/core/Error.h>
#include <csom/exports/DistanceField.h>
#include <csom/exports/GltfFile.h>
#include <csom/exports/NavigationFiles.h>
#include <csom/exports/OctomapFile.h>
#include <csom/exports/PointFiles.h>
#include <csom/exports/VdbFile.h>
#include <csom/io/MapFile.h>
#include <csom/io/TextParser.h>
#include <csom/mrpt_exports/MrptFiles.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "Arguments.h"
#include "OutputPaths.h"
#include "Progress.h"
#include "VoxelFilterArguments.h"
#include "commands.h"

namespace csom {

namespace {

struct ExportFormat;

struct ExportArguments {
  std::string file;
  std::string output;
  const ExportFormat* format = nullptr;
  std::shared_ptr<VoxelFilterArguments> filter = std::make_shared<VoxelFilterArguments>();
  std::vector<std::string> traversable;
  NavigationOptions navigation;  ///< without classes
  double max_distance = 5;       ///< of a distance field [m]
};

/// Writes arguments.output, and returns what was written, for people.
using WriteExport = std::string(const ExportArguments& arguments, const VoxelSelection& voxels,
                                const LabelSet& labels);

struct ExportFormat {
  const char* name;
  const char* help;
  WriteExport* write;
  /// Options of the command that it alone takes, or shares with others.
  std::vector<std::string> options = {};
};

std::string countText(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what;
}

/// Formats that need nothing but a file.
template <std::size_t (*kWrite)(const VoxelSelection&, const LabelSet&, const std::string&)>
std::string writeVoxels(const ExportArguments& arguments, const VoxelSelection& voxels,
                        const LabelSet& labels) {
  return countText(kWrite(voxels, labels, arguments.output), "voxels");
}

NavigationGrid navigationGrid(const ExportArguments& arguments, const VoxelSelection& voxels,
                              const LabelSet& labels) {
  NavigationOptions options = arguments.navigation;
  options.traversable = classesNamed("--traversable", arguments.traversable, labels);
  return NavigationGrid(voxels, options);
}

std::string cellsOf(const NavigationGrid& grid) {
  using State = NavigationGrid::State;
  return std::to_string(grid.width()) + " x " + std::to_string(grid.height()) + " cells, " +
         std::to_string(grid.count(State::Free)) + " free, " +
         std::to_string(grid.count(State::Occupied)) + " occupied";
}

std::string writeNav2(const ExportArguments& arguments, const VoxelSelection& voxels,
                      const LabelSet& labels) {
  const NavigationGrid grid = navigationGrid(arguments, voxels, labels);
  writeNavigationFiles(grid, labels, NavigationFiles::named(arguments.output));
  return cellsOf(grid);
}

std::string writeGridmapFile(const ExportArguments& arguments, const VoxelSelection& voxels,
                             const LabelSet& labels) {
  const NavigationGrid grid = navigationGrid(arguments, voxels, labels);
  writeGridmap(grid, arguments.output);
  return cellsOf(grid);
}

std::string writeDistances(const ExportArguments& arguments, const VoxelSelection& voxels,
                           const LabelSet& /*labels*/) {
  const DistanceField field(voxels, arguments.max_distance);
  writeDistanceField(field, arguments.output);
  const auto [width, height, depth] = field.size();
  return std::to_string(width) + " x " + std::to_string(height) + " x " + std::to_string(depth) +
         " voxels";
}

/// All formats, in the order of the help.
const std::vector<ExportFormat>& formats() {
  static const std::vector<ExportFormat> all{
      {"ply", "points with colour, class, probability, variance: MeshLab, CloudCompare",
       writeVoxels<writePly>},
      {"pcd", "points x y z rgb label, in single precision: PCL", writeVoxels<writePcd>},
      {"csv", "x,y,z,class_id,class_name,probability,variance,evidence", writeVoxels<writeCsv>},
      {"npz", "the same as NumPy arrays", writeVoxels<writeNpz>},
      {"octomap", ".ot: occupancy and colours of classes; .bt: occupancy. With free space",
       [](const auto& a, const auto& voxels, const auto& labels) {
         return countText(writeOctomap(voxels, labels, a.output), "occupied voxels");
       }},
      {"nav2",
       ".yaml and .pgm of ROS's map_server, and a .png of classes",
       writeNav2,
       {"--traversable", "--obstacle-band", "--robot-height"}},
      {"gridmap",
       "the same cells as MRPT's COccupancyGridMap2D",
       writeGridmapFile,
       {"--traversable", "--obstacle-band", "--robot-height"}},
      {"points", "points with class ids as MRPT's CPointsMapXYZI", writeVoxels<writePointMap>},
      {"glb", "mesh of the surface, a material a class: web, Blender",
       [](const auto& a, const auto& voxels, const auto& labels) {
         return countText(writeGlb(voxels, labels, a.output), "triangles");
       }},
      {"vdb", "grids of class, occupancy and variance: OpenVDB", writeVoxels<writeVdb>},
      {"esdf",
       "distances to the nearest obstacle as NumPy arrays",
       writeDistances,
       {"--max-distance"}},
  };
  return all;
}

/// Throws ConfigError, which takes one line, as any other export that cannot be done.
const ExportFormat* formatNamed(const std::string& name) {
  std::string known;
  for (const ExportFormat& format : formats()) {
    if (CLI::detail::to_lower(name) == format.name) return &format;
    known += (known.empty() ? "" : ", ") + std::string(format.name);
  }
  throw ConfigError("--to: no format '" + name + "'; there are " + known);
}

std::vector<std::string> listOutputs(const ExportArguments& arguments) {
  if (arguments.format->write != writeNav2) return {arguments.output};
  const NavigationFiles files = NavigationFiles::named(arguments.output);
  return {files.yaml, files.image, files.classes};
}

void runExport(const ExportArguments& arguments) {
  requireSeparateOutputs(listOutputs(arguments), {arguments.file});
  const MapDocument document = loadMap(arguments.file);
  std::string written;
  {
    Progress progress("exporting");
    const VoxelSelection voxels(
        document.map, arguments.filter->filterFor(document.labels), arguments.filter->frame,
        [&](std::size_t seen, std::size_t known) { progress.update(seen, known); });
    written = arguments.format->write(arguments, voxels, document.labels);
  }
  // Not to standard output: -o may be /dev/stdout.
  std::fprintf(stderr, "%s: %s\n", detail::printable(arguments.output).c_str(), written.c_str());
}

NavigationOptions::Band parseBand(const std::string& text) {
  const auto n = parseNumbers<2>("--obstacle-band", text);
  if (!(n[0] < n[1]))
    throw CLI::ValidationError("--obstacle-band", "'" + text + "': z0 < z1 must hold");
  return {n[0], n[1]};
}

/// Adds options that only some formats take; a use with another format is refused.
void addFormatOptions(CLI::App& command, const std::shared_ptr<ExportArguments>& arguments) {
  command
      .add_option("--traversable", arguments->traversable,
                  "nav2, gridmap: classes that the robot drives on (names or ids)")
      ->delimiter(',')
      ->type_name("A,B");
  command
      .add_option_function<std::string>(
          "--obstacle-band",
          [arguments](const std::string& text) { arguments->navigation.band = parseBand(text); },
          "nav2, gridmap: only what lies between these heights counts")
      ->type_name("z0,z1");
  command
      .add_option("--robot-height", arguments->navigation.robot_height,
                  "nav2, gridmap: what begins this far above the ground is no obstacle")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->type_name("METRES");
  command
      .add_option("--max-distance", arguments->max_distance,
                  "esdf: distances are no longer than this")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->type_name("METRES");
  // After all options were read: by then the format is known.
  command.parse_complete_callback([&command, arguments] {
    std::map<std::string, std::string> takers;
    for (const ExportFormat& format : formats())
      for (const std::string& option : format.options)
        takers[option] += (takers[option].empty() ? "" : " and ") + std::string(format.name);
    const std::vector<std::string>& taken = arguments->format->options;
    for (const auto& [option, formats] : takers)
      if (command.get_option(option)->count() > 0 &&
          std::find(taken.begin(), taken.end(), option) == taken.end())
        throw CLI::ValidationError(option, "is an option of --to " + formats);
  });
}

std::string formatsHelp() {
  std::string help = "Formats:\n";
  for (const ExportFormat& format : formats())
    help += "  " + std::string(format.name) +
            std::string(
                std::max<std::size_t>(9, std::strlen(format.name) + 1) - std::strlen(format.name),
                ' ') +
            format.help + "\n";
  return help;
}

}  // namespace

void addExportCommand(CLI::App& program) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = program.add_subcommand("export", "Write a map in a format of other programs");
  command->add_option("MAP", arguments->file, "map file (.csom)")->required();
  command
      ->add_option_function<std::string>(
          "--to", [arguments](const std::string& name) { arguments->format = formatNamed(name); },
          "one of the formats below")
      ->required()
      ->type_name("FORMAT");
  command->add_option("-o,--output", arguments->output, "file to write")->required();
  addVoxelFilter(*command, arguments->filter);
  addFormatOptions(*command, arguments);
  command->footer(formatsHelp() +
                  "docs/exports.md says more.\n\n"
                  "Examples:\n"
                  "  csom export out/map.csom --to ply -o map.ply\n"
                  "  csom export out/map.csom --to csv --classes road,sidewalk -o ground.csv\n"
                  "  csom export out/map.csom --to octomap -o map.ot\n"
                  "  csom export out/map.csom --to nav2 --traversable road,sidewalk -o map.yaml\n"
                  "  csom export out/map.csom --to esdf --box 0,-10,0,20,10,3 -o distances.npz");
  command->callback([arguments] { runExport(*arguments); });
}

}  // namespace csom
