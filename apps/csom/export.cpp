// SPDX-License-Identifier: BSD-3-Clause
// csom export: a map in the formats of other programs.
#include <csom/core/Error.h>
#include <csom/exports/NavigationFiles.h>
#include <csom/exports/OctomapFile.h>
#include <csom/exports/PointFiles.h>
#include <csom/io/MapFile.h>
#include <csom/io/TextParser.h>
#include <csom/mrpt_exports/MrptFiles.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "Arguments.h"
#include "OutputPaths.h"
#include "Progress.h"
#include "commands.h"

namespace csom {

namespace {

enum class ExportFormat { Ply, Pcd, Csv, Npz, Octomap, Nav2, Gridmap, Points };

const std::map<std::string, ExportFormat>& formats() {
  static const std::map<std::string, ExportFormat> words{
      {"ply", ExportFormat::Ply},         {"pcd", ExportFormat::Pcd},
      {"csv", ExportFormat::Csv},         {"npz", ExportFormat::Npz},
      {"octomap", ExportFormat::Octomap}, {"nav2", ExportFormat::Nav2},
      {"gridmap", ExportFormat::Gridmap}, {"points", ExportFormat::Points}};
  return words;
}

bool isForNavigation(ExportFormat format) {
  return format == ExportFormat::Nav2 || format == ExportFormat::Gridmap;
}

struct ExportArguments {
  std::string file;
  std::string output;
  ExportFormat format = ExportFormat::Ply;
  bool all = false;
  std::vector<std::string> classes;
  VoxelFilter filter;  ///< without classes, which only the map's label set knows
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  std::vector<std::string> traversable;
  NavigationOptions navigation;  ///< without classes
};

/// Class ids of names or numbers.
std::set<ClassId> classesNamed(const std::string& option, const std::vector<std::string>& names,
                               const LabelSet& labels) {
  std::set<ClassId> classes;
  for (const std::string& name : names) {
    std::optional<ClassId> id = labels.classByName(name);
    int number = -1;
    if (!id && detail::parseNumber(name, number) && number >= 0 &&
        number < labels.numberOfClasses())
      id = static_cast<ClassId>(number);
    if (!id || *id == kFreeClass) {
      std::vector<std::string> known;
      for (const LabelClass& c : labels.classes())
        if (c.id != kFreeClass) known.push_back(detail::printable(c.name));
      throw ConfigError(option + ": no class " + detail::quoted(name) + "; the map has " +
                        detail::joined(known));
    }
    classes.insert(*id);
  }
  return classes;
}

std::string voxelsText(std::size_t count) {
  return std::to_string(count) + " voxels";
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

/// Returns what was written, for people.
std::string writeExport(const ExportArguments& arguments, const VoxelSelection& voxels,
                        const LabelSet& labels) {
  switch (arguments.format) {
    case ExportFormat::Ply:
      return voxelsText(writePly(voxels, labels, arguments.output));
    case ExportFormat::Pcd:
      return voxelsText(writePcd(voxels, labels, arguments.output));
    case ExportFormat::Csv:
      return voxelsText(writeCsv(voxels, labels, arguments.output));
    case ExportFormat::Npz:
      return voxelsText(writeNpz(voxels, labels, arguments.output));
    case ExportFormat::Octomap:
      return voxelsText(writeOctomap(voxels, labels, arguments.output));
    case ExportFormat::Points:
      return voxelsText(writePointMap(voxels, labels, arguments.output));
    case ExportFormat::Nav2:
    case ExportFormat::Gridmap:
      return writeNavigation(arguments, voxels, labels);
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
  VoxelFilter filter = arguments.filter;
  filter.free_voxels = arguments.all;
  filter.classes = classesNamed("--classes", arguments.classes, document.labels);
  std::string written;
  {
    Progress progress("exporting");
    const VoxelSelection voxels(
        document.map, filter, arguments.frame,
        [&](std::size_t seen, std::size_t known) { progress.update(seen, known); });
    written = writeExport(arguments, voxels, document.labels);
  }
  // Not to standard output: -o may be /dev/stdout.
  std::fprintf(stderr, "%s: %s\n", arguments.output.c_str(), written.c_str());
}

Eigen::AlignedBox3d parseBox(const std::string& text) {
  const auto n = parseNumbers<6>("--box", text);
  const Eigen::AlignedBox3d box(Eigen::Vector3d(n[0], n[1], n[2]),
                                Eigen::Vector3d(n[3], n[4], n[5]));
  if (!(box.sizes().minCoeff() > 0))
    throw CLI::ValidationError(
        "--box", "'" + text + "' is not a box: x0 < x1, y0 < y1 and z0 < z1 must hold");
  return box;
}

Eigen::Isometry3d parseFrame(const std::string& text) {
  const auto n = parseNumbers<6>("--frame", text);
  const auto rotation = [&](std::size_t i, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(n[i] * M_PI / 180, axis);
  };
  return Eigen::Translation3d(n[0], n[1], n[2]) * rotation(3, Eigen::Vector3d::UnitZ()) *
         rotation(4, Eigen::Vector3d::UnitY()) * rotation(5, Eigen::Vector3d::UnitX());
}

void addFilters(CLI::App& command, const std::shared_ptr<ExportArguments>& arguments) {
  command.add_flag("--all", arguments->all, "free voxels as well");
  command
      .add_option("--classes", arguments->classes, "only voxels of these classes (names or ids)")
      ->delimiter(',')
      ->type_name("A,B");
  command
      .add_option_function<std::string>(
          "--box", [arguments](const std::string& text) { arguments->filter.box = parseBox(text); },
          "only voxels whose centres lie in this box of the map's frame")
      ->type_name("x0,y0,z0,x1,y1,z1");
  command
      .add_option("--min-probability", arguments->filter.min_probability,
                  "only voxels whose class has at least this probability")
      ->check(CLI::Range(0.0, 1.0))
      ->type_name("P");
  command
      .add_option("--min-evidence", arguments->filter.min_evidence,
                  "only voxels with at least this evidence (of all classes)")
      ->check(CLI::NonNegativeNumber)
      ->type_name("E");
  command
      .add_option_function<std::string>(
          "--frame", [arguments](const std::string& text) { arguments->frame = parseFrame(text); },
          "pose of the map in the exported frame: metres, degrees")
      ->type_name("x,y,z,yaw,pitch,roll");
}

void addNavigation(CLI::App& command, const std::shared_ptr<ExportArguments>& arguments) {
  std::vector<CLI::Option*> options;
  options.push_back(
      command
          .add_option("--traversable", arguments->traversable,
                      "nav2, gridmap: classes that the robot drives on (names or ids)")
          ->delimiter(',')
          ->type_name("A,B"));
  options.push_back(command
                        .add_option_function<std::string>(
                            "--obstacle-band",
                            [arguments](const std::string& text) {
                              const auto n = parseNumbers<2>("--obstacle-band", text);
                              if (!(n[0] < n[1]))
                                throw CLI::ValidationError("--obstacle-band",
                                                           "'" + text + "': z0 < z1 must hold");
                              arguments->navigation.band = NavigationOptions::Band{n[0], n[1]};
                            },
                            "nav2, gridmap: only what lies between these heights counts")
                        ->type_name("z0,z1"));
  options.push_back(
      command
          .add_option("--robot-height", arguments->navigation.robot_height,
                      "nav2, gridmap: what begins this far above the ground is no obstacle")
          ->check(CLI::PositiveNumber)
          ->capture_default_str()
          ->type_name("METRES"));
  // A later callback than the options' own: by then the format is known.
  command.parse_complete_callback([arguments, options] {
    for (const CLI::Option* option : options)
      if (option->count() > 0 && !isForNavigation(arguments->format))
        throw CLI::ValidationError(option->get_name(), "is an option of --to nav2 and gridmap");
  });
}

}  // namespace

void addExportCommand(CLI::App& program) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = program.add_subcommand("export", "Write a map in a format of other programs");
  command->add_option("MAP", arguments->file, "map file (.csom)")->required();
  command->add_option("--to", arguments->format, "one of the formats below")
      ->required()
      ->transform(oneOf(formats()))
      ->type_name("FORMAT");
  command->add_option("-o,--output", arguments->output, "file to write")->required();
  addFilters(*command, arguments);
  addNavigation(*command, arguments);
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
      "docs/exports.md says more.\n\n"
      "Examples:\n"
      "  csom export out/map.csom --to ply -o map.ply\n"
      "  csom export out/map.csom --to csv --classes road,sidewalk -o ground.csv\n"
      "  csom export out/map.csom --to octomap -o map.ot\n"
      "  csom export out/map.csom --to nav2 --traversable road,sidewalk -o map.yaml");
  command->callback([arguments] { runExport(*arguments); });
}

}  // namespace csom
