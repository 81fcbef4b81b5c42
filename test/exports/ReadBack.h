// SPDX-License-Identifier: BSD-3-Clause
// Exported files, read by libraries that other people wrote, as voxels and their classes.
#pragma once

#include <csom/core/SemanticMap.h>
#include <csom/io/LabelSet.h>

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace csom::test {

using VoxelClasses = std::map<std::array<int, 3>, ClassId>;

/// A format of `csom export` that holds voxels.
struct VoxelFormat {
  std::string name;       ///< for --to
  std::string extension;  ///< of the file
  bool free_voxels;       ///< the file holds them, too
  bool classes;           ///< otherwise class 1 stands for all occupied ones
  std::function<VoxelClasses(const std::string& file, double resolution, const LabelSet& labels)>
      read;
};

/// All that this build can write and read.
std::vector<VoxelFormat> voxelFormats();

/// What the file of such a format must hold.
VoxelClasses voxelsOf(const SemanticMap& map, const VoxelFormat& format);

}  // namespace csom::test
