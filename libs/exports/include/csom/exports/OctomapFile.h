// SPDX-License-Identifier: BSD-3-Clause
// A map as an octree of OctoMap.
#pragma once

#include <csom/exports/VoxelSelection.h>
#include <csom/io/LabelSet.h>

#include <cstddef>
#include <string>

namespace csom {

/// Writes a ColorOcTree (.ot: log odds, and the colour of the class) or, if `file` ends in ".bt", a
/// binary OcTree (occupied or free). Free voxels of the map that pass the filters go along; what
/// does not pass is unknown to the tree. A leaf is occupied for OctoMap exactly if the voxel is for
/// the map: its log odds are those of the occupancy, moved to that side of 0, and clamped to
/// OctoMap's usual limits, so that equal neighbours are pruned.
///
/// The tree is built in memory. Returns the number of occupied voxels. Throws FileError;
/// ConfigError if `file` ends in neither, if the selection is empty, or if voxels lie beyond the
/// 32,768 voxels from the origin that an octree reaches; std::invalid_argument if `labels` has not
/// the map's number of classes.
std::size_t writeOctomap(const VoxelSelection& voxels, const LabelSet& labels,
                         const std::string& file);

}  // namespace csom
