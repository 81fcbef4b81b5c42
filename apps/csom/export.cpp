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

#include <cstdio>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "Arguments.h"
#include "OutputPaths.h"
#include "Progress.h"
#include "VoxelFilterArguments.h"
#include "commands.h"

namespace csom {

namespace {

enum class ExportFormat { Ply, Pcd, Csv, Npz, Octomap, Nav2, Gridmap, Points, Glb, Vdb, Esdf };

const std::map<std::string, ExportFormat>& formats() {
  static const std::map<std::string, ExportFormat> words{
      {"ply", ExportFormat::Ply},         {"pcd", ExportFormat::Pcd},
      {"csv", ExportFormat::Csv},         {"npz", ExportFormat::Npz},
      {"octomap", ExportFormat::Octomap}, {"nav2", ExportFormat::Nav2},
      {"gridmap", ExportFormat::Gridmap}, {"points", ExportFormat::Points},
      {"glb", ExportFormat::Glb},         {"vdb", ExportFormat::Vdb},
      {"esdf", ExportFormat::Esdf}};
  return words;
}

/// Throws ConfigError, which takes one line, as any other export that cannot be done.
ExportFormat formatNamed(const std::string& name) {
  const auto found = formats().find(CLI::detail::to_lower(name));
  if (found != formats().end()) return found->second;
  std::string known;
  for (const auto& [word, format] : formats()) known += (known.empty() ? "" : ", ") + word;
  throw ConfigError("--to: no format '" + name + "'; there are " + known);
}

struct ExportArguments {
  std::string file;
  std::string output;
  ExportFormat format = ExportFormat::Ply;
  std::shared_ptr<VoxelFilterArguments> filter = std::make_shared<VoxelFilterArguments>();
  std::vector<std::string> traversable;
  NavigationOptions navigation;  ///< without classes
  double max_distance = 5;       ///< of a distance field [m]
};

std::string countText(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what;
}

std::string writeNavigation(const ExportArguments& arguments, const VoxelSelection& voxels,
                            const LabelSet& labels) {
  NavigationOptions options = arguments.navigation;
  options.traversable = classesNamed("--traversable", arguments.traversable, labels);
  const NavigationGrid grid(voxels, options);
  if (arguments.format == ExportFormat::Gridmap)
    writeGridmap(grid, arguments.output);
  else
    writeNavigationFiles(grid, labels, NavigationFiles::named(arguments.output));
  using State = NavigationGrid::State;
  return std::to_string(grid.width()) + " x " + std::to_string(grid.height()) + " cells, " +
         std::to_string(grid.count(State::Free)) + " free, " +
         std::to_string(grid.count(State::Occupied)) + " occupied";
}

std::string writeDistances(const ExportArguments& arguments, const VoxelSelection& voxels) {
  const DistanceField field(voxels, arguments.max_distance);
  writeDistanceField(field, arguments.output);
  const auto [width, height, depth] = field.size();
  return std::to_string(width) + " x " + std::to_string(height) + " x " + std::to_string(depth) +
         " voxels";
}

/// Returns what was written, for people.
std::string writeExport(const ExportArguments& arguments, const VoxelSelection& voxels,
                        const LabelSet& labels) {
  const std::string& output = arguments.output;
  switch (arguments.format) {
    case ExportFormat::Ply:
      return countText(writePly(voxels, labels, output), "voxels");
    case ExportFormat::Pcd:
      return countText(writePcd(voxels, labels, output), "voxels");
    case ExportFormat::Csv:
      return countText(writeCsv(voxels, labels, output), "voxels");
    case ExportFormat::Npz:
      return countText(writeNpz(voxels, labels, output), "voxels");
    case ExportFormat::Octomap:
      return countText(writeOctomap(voxels, labels, output), "occupied voxels");
    case ExportFormat::Points:
      return countText(writePointMap(voxels, labels, output), "voxels");
    case ExportFormat::Glb:
      return countText(writeGlb(voxels, labels, output), "triangles");
    case ExportFormat::Vdb:
      return countText(writeVdb(voxels, labels, output), "voxels");
    case ExportFormat::Nav2:
    case ExportFormat::Gridmap:
      return writeNavigation(arguments, voxels, labels);
    case ExportFormat::Esdf:
      return writeDistances(arguments, voxels);
  }
  throw std::invalid_argument("export: unknown format");
}

std::vector<std::string> outputsOf(const ExportArguments& arguments) {
  if (arguments.format != ExportFormat::Nav2) return {arguments.output};
  const NavigationFiles files = NavigationFiles::named(arguments.output);
  return {files.yaml, files.image, files.classes};
}

void runExport(const ExportArguments& arguments) {
  requireSeparateOutputs(outputsOf(arguments), {arguments.file});
  const MapDocument document = loadMap(arguments.file);
  std::string written;
  {
    Progress progress("exporting");
    const VoxelSelection voxels(
        document.map, arguments.filter->filterFor(document.labels), arguments.filter->frame,
        [&](std::size_t seen, std::size_t known) { progress.update(seen, known); });
    written = writeExport(arguments, voxels, document.labels);
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

void addFormatOptions(CLI::App& command, const std::shared_ptr<ExportArguments>& arguments) {
  CLI::Option* traversable =
      command
          .add_option("--traversable", arguments->traversable,
                      "nav2, gridmap: classes that the robot drives on (names or ids)")
          ->delimiter(',')
          ->type_name("A,B");
  CLI::Option* band = command
                          .add_option_function<std::string>(
                              "--obstacle-band",
                              [arguments](const std::string& text) {
                                arguments->navigation.band = parseBand(text);
                              },
                              "nav2, gridmap: only what lies between these heights counts")
                          ->type_name("z0,z1");
  CLI::Option* height =
      command
          .add_option("--robot-height", arguments->navigation.robot_height,
                      "nav2, gridmap: what begins this far above the ground is no obstacle")
          ->check(CLI::PositiveNumber)
          ->capture_default_str()
          ->type_name("METRES");
  CLI::Option* distance = command
                              .add_option("--max-distance", arguments->max_distance,
                                          "esdf: distances are no longer than this")
                              ->check(CLI::PositiveNumber)
                              ->capture_default_str()
                              ->type_name("METRES");
  // After all options were read: by then the format is known.
  command.parse_complete_callback([=] {
    const auto requireFormat = [](const CLI::Option* option, bool fits, const char* words) {
      if (option->count() > 0 && !fits)
        throw CLI::ValidationError(option->get_name(),
                                   std::string("is an option of --to ") + words);
    };
    const ExportFormat format = arguments->format;
    const bool navigation = format == ExportFormat::Nav2 || format == ExportFormat::Gridmap;
    for (const CLI::Option* option : {traversable, band, height})
      requireFormat(option, navigation, "nav2 and gridmap");
    requireFormat(distance, format == ExportFormat::Esdf, "esdf");
  });
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
  command->footer(
      "Formats:\n"
      "  ply      points with colour, class, probability, variance: MeshLab, CloudCompare\n"
      "  pcd      points x y z rgb label, in single precision: PCL\n"
      "  csv      x,y,z,class_id,class_name,probability,variance,evidence\n"
      "  npz      the same as NumPy arrays\n"
      "  octomap  .ot: occupancy and colours of classes; .bt: occupancy. With free space\n"
      "  nav2     .yaml and .pgm of ROS's map_server, and a .png of classes\n"
      "  gridmap  the same cells as MRPT's COccupancyGridMap2D\n"
      "  points   points with class ids as MRPT's CPointsMapXYZI\n"
      "  glb      mesh of the surface, a material a class: web, Blender\n"
      "  vdb      grids of class, occupancy and variance: OpenVDB\n"
      "  esdf     distances to the nearest obstacle as NumPy arrays\n"
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
