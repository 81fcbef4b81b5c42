// SPDX-License-Identifier: BSD-3-Clause
// Options that choose voxels of a map.
#pragma once

#include <csom/exports/VoxelSelection.h>
#include <csom/io/LabelSet.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace csom {

/// Class ids of names or numbers. Throws ConfigError that names `option` and the classes there are.
std::set<ClassId> classesNamed(const std::string& option, const std::vector<std::string>& names,
                               const LabelSet& labels);

/// --classes, --box, --min-probability, --min-evidence, --all and --frame.
struct VoxelFilterArguments {
  std::vector<std::string> classes;
  VoxelFilter filter;  ///< without classes, which only the map's label set knows
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();

  VoxelFilter filterFor(const LabelSet& labels) const;
};

/// The command keeps `arguments` alive.
void addVoxelFilter(CLI::App& command, const std::shared_ptr<VoxelFilterArguments>& arguments);

}  // namespace csom
