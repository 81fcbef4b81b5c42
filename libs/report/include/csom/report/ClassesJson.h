// SPDX-License-Identifier: BSD-3-Clause
// The classes of a map as JSON, the same wherever a program prints them.
#pragma once

#include <csom/report/MapFigures.h>

#include <nlohmann/json.hpp>
#include <vector>

namespace csom {

/// An array of objects with the keys id, name, color, voxels, volume_m3, share, mean_probability.
nlohmann::ordered_json classesToJson(const std::vector<ClassFigures>& classes);

}  // namespace csom
