// SPDX-License-Identifier: BSD-3-Clause
// The surface of a map as a mesh.
#pragma once

#include <csom/exports/VoxelSelection.h>
#include <csom/io/LabelSet.h>

#include <cstddef>
#include <string>

namespace csom {

/// Writes the faces between occupied voxels of the selection and what is none as binary glTF 2.0:
/// a node, a mesh and a material for each class that occurs, named and coloured as the class,
/// coplanar faces merged to rectangles of two triangles. glTF's y points up, where the map's z
/// does; units are metres.
///
/// The mesh is built in memory, some 300 bytes a rectangle. Returns the number of triangles. Throws
/// FileError; ConfigError if the selection is empty or single precision would move it by more than
/// half a voxel; std::invalid_argument if `labels` has not the map's number of classes.
std::size_t writeGlb(const VoxelSelection& voxels, const LabelSet& labels, const std::string& file);

}  // namespace csom
