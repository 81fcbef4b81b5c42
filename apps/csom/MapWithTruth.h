// SPDX-License-Identifier: BSD-3-Clause
// A map and the map of the truth that it is scored by.
#pragma once

#include <csom/io/MapFile.h>

#include <string>

namespace csom {

struct MapWithTruth {
  MapDocument map;
  MapDocument truth;
};

/// Throws FileError, also if the truth is empty or of another resolution; ConfigError if the label
/// sets differ.
MapWithTruth loadMapWithTruth(const std::string& map, const std::string& truth);

}  // namespace csom
