// SPDX-License-Identifier: BSD-3-Clause
#include "Output.h"

#include <array>
#include <cstdio>

namespace csom {

void printJson(const Json& json) {
  std::puts(json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
}

Json toJson(const Eigen::Vector3d& point) {
  return {point.x(), point.y(), point.z()};
}

Json toJson(const VoxelIndex& voxel) {
  return {voxel.x, voxel.y, voxel.z};
}

std::string toText(const Eigen::Vector3d& point) {
  return toText(point.x()) + " " + toText(point.y()) + " " + toText(point.z());
}

std::string toText(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

}  // namespace csom
