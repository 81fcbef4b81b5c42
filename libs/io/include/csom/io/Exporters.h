// SPDX-License-Identifier: BSD-3-Clause
// The voxels of a map as a table or a point cloud for other programs.
#pragma once

#include <csom/core/SemanticMap.h>
#include <csom/io/LabelSet.h>

#include <cstddef>
#include <string>

namespace csom {

/// Ply: binary little-endian, vertices `double x y z, uchar red green blue class, float probability
/// variance`. Pcd: v0.7 binary, `float x y z, rgb (packed in a float), uint32 label`. Csv: header
/// line and columns x,y,z,class_id,class_name,probability,variance,evidence; numbers are the
/// shortest text that reads back to the same double.
enum class ExportFormat { Ply, Pcd, Csv };
/// Occupied: voxels whose most likely class is not free. Known: free ones as well.
enum class ExportVoxels { Occupied, Known };

/// Writes one vertex or line a voxel, in the order of SemanticMap::forEachVoxel: its centre in the
/// map frame [m], its most likely class, that class's probability and variance, and the evidence of
/// all classes together. The file appears complete or not at all (see OutputFile).
///
/// Returns the number of voxels. Throws FileError; std::invalid_argument if `labels` has not the
/// map's number of classes.
std::size_t exportMap(const SemanticMap& map, const LabelSet& labels, ExportFormat format,
                      ExportVoxels voxels, const std::string& file);

}  // namespace csom
