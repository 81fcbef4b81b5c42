// SPDX-License-Identifier: BSD-3-Clause
// Maps as files of MRPT's own map types.
#pragma once

#include <csom/exports/NavigationGrid.h>
#include <csom/io/LabelSet.h>

#include <cstddef>
#include <string>

namespace csom {

/// Both write a serialised object, not compressed, which MRPT's CFileGZInputStream reads as it
/// reads compressed ones. The file appears complete or not at all. They throw FileError.

/// A mrpt::maps::COccupancyGridMap2D: free cells are free with probability 0.99, occupied ones with
/// 0.01, unknown ones with 0.5. Throws ConfigError if MRPT's single precision cannot place the
/// grid.
void writeGridmap(const NavigationGrid& grid, const std::string& file);

/// A mrpt::maps::CPointsMapXYZI of the voxels' centres, whose intensity is the class id. Built in
/// memory, 16 bytes a voxel. Returns the number of voxels. Throws ConfigError as writePcd() does.
std::size_t writePointMap(const VoxelSelection& voxels, const LabelSet& labels,
                          const std::string& file);

}  // namespace csom
