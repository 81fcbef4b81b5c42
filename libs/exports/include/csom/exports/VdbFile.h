// SPDX-License-Identifier: BSD-3-Clause
// A map as grids of OpenVDB.
#pragma once

#include <csom/exports/VoxelSelection.h>
#include <csom/io/LabelSet.h>

#include <cstddef>
#include <string>

namespace csom {

/// Writes the grids `class` (int32, 0 = free), `occupancy` and `variance` (float) of the known
/// voxels of the selection, free ones included; what does not pass the filters is inactive. World
/// coordinates are metres in the export's frame, voxels' centres at (i+½)·r.
///
/// The grids are built in memory. Returns the number of voxels. Throws FileError; ConfigError if
/// the selection is empty, or if csom-vdb.so cannot be loaded, which is built where OpenVDB is.
std::size_t writeVdb(const VoxelSelection& voxels, const LabelSet& labels, const std::string& file);

}  // namespace csom
