// SPDX-License-Identifier: BSD-3-Clause
// What must hold before an export begins.
#pragma once

#include <csom/exports/VoxelSelection.h>
#include <csom/io/LabelSet.h>
#include <csom/io/OutputFile.h>

#include <string>

namespace csom::detail {

/// Throws std::invalid_argument if `labels` has not the map's number of classes, and ConfigError if
/// there is no voxel to be exported.
void checkExport(const VoxelSelection& voxels, const LabelSet& labels);

/// Throws ConfigError if single precision would move a point by more than half a voxel.
void checkSinglePrecision(const Eigen::Vector3d& point, double resolution);

/// For formats whose libraries open a file by name, jump in it or replace it. Throws FileError if
/// the target is a pipe or a device.
void requireRegularFile(const OutputFile& file, const std::string& target);

}  // namespace csom::detail
