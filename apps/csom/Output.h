// SPDX-License-Identifier: BSD-3-Clause
// Printing of results: JSON for programs, aligned text for people.
#pragma once

#include <csom/core/DirichletVoxel.h>
#include <csom/core/SemanticMap.h>
#include <csom/io/LabelSet.h>

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>

namespace csom {

/// Keys in the order in which they were added.
using Json = nlohmann::ordered_json;

/// Prints to standard output, indented; bytes that are no UTF-8 become U+FFFD.
void printJson(const Json& json);

/// [x, y, z].
Json toJson(const Eigen::Vector3d& point);
Json toJson(const VoxelIndex& voxel);
/// "1.5 -2 0.25": as many digits as a person wants to read.
std::string toText(const Eigen::Vector3d& point);
/// Six significant digits.
std::string toText(double value);

}  // namespace csom
