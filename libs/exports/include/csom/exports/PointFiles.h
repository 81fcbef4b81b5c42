// SPDX-License-Identifier: BSD-3-Clause
// The voxels of a map as point clouds and tables: PLY, PCD, CSV and NumPy files.
#pragma once

#include <csom/exports/VoxelSelection.h>
#include <csom/io/LabelSet.h>

#include <cstddef>
#include <string>

namespace csom {

/// All of these write one point a voxel, in the order of VoxelSelection::forEach, and return the
/// number of voxels. The file appears complete or not at all (see OutputFile). They throw
/// FileError; ConfigError if the selection is empty or cannot be said in the format;
/// std::invalid_argument if `labels` has not the map's number of classes.

/// Binary little-endian PLY: `double x y z, uchar red green blue class, float probability
/// variance`.
std::size_t writePly(const VoxelSelection& voxels, const LabelSet& labels, const std::string& file);

/// Binary PCD v0.7: `float x y z, rgb (packed in a float), uint32 label`. Refuses coordinates that
/// single precision would move by more than half a voxel.
std::size_t writePcd(const VoxelSelection& voxels, const LabelSet& labels, const std::string& file);

/// A header line and the columns x,y,z,class_id,class_name,probability,variance,evidence; numbers
/// are the shortest text that reads back to the same double.
std::size_t writeCsv(const VoxelSelection& voxels, const LabelSet& labels, const std::string& file);

/// For numpy.load(): arrays `center` (N×3 doubles), `class_id` (uint8), `probability`, `variance`,
/// `evidence` (N doubles), `class_name` (K byte strings) and `resolution`. Columns pass through
/// temporary files; `file` must be a regular one.
std::size_t writeNpz(const VoxelSelection& voxels, const LabelSet& labels, const std::string& file);

}  // namespace csom
