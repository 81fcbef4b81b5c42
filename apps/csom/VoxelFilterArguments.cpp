// SPDX-License-Identifier: BSD-3-Clause
#include "VoxelFilterArguments.h"

#include <csom/core/Error.h>
#include <csom/io/TextParser.h>

#include <cmath>
#include <optional>

#include "Arguments.h"

namespace csom {

namespace {

Eigen::AlignedBox3d parseBox(const std::string& text) {
  const auto n = parseNumbers<6>("--box", text);
  const Eigen::AlignedBox3d box(Eigen::Vector3d(n[0], n[1], n[2]),
                                Eigen::Vector3d(n[3], n[4], n[5]));
  if (!(box.sizes().minCoeff() >= 0))
    throw CLI::ValidationError(
        "--box", "'" + text + "' is not a box: x0 <= x1, y0 <= y1 and z0 <= z1 must hold");
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

}  // namespace

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

VoxelFilter VoxelFilterArguments::filterFor(const LabelSet& labels) const {
  VoxelFilter complete = filter;
  complete.classes = classesNamed("--classes", classes, labels);
  return complete;
}

void addVoxelFilter(CLI::App& command, const std::shared_ptr<VoxelFilterArguments>& arguments) {
  command.add_flag("--all", arguments->filter.free_voxels, "free voxels as well");
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

}  // namespace csom
