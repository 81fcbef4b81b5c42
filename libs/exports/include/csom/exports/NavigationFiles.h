// SPDX-License-Identifier: BSD-3-Clause
// A navigation grid as a map of ROS's map_server.
#pragma once

#include <csom/exports/NavigationGrid.h>
#include <csom/io/LabelSet.h>

#include <string>

namespace csom {

/// The files that belong together.
struct NavigationFiles {
  std::string yaml;     ///< NAME.yaml: resolution, origin, thresholds
  std::string image;    ///< NAME.pgm: 254 free, 0 occupied, 205 unknown; the first row is at high y
  std::string classes;  ///< NAME_classes.png: the same cells; index of the palette = class id

  /// Throws ConfigError if `yaml` does not end in ".yaml".
  static NavigationFiles named(const std::string& yaml);
};

/// Writes all three. Unknown cells of the PNG are transparent and have the index behind the last
/// class. None appears if one of them cannot be written. Throws FileError; ConfigError if there are
/// 256 classes, which leaves no index for unknown.
void writeNavigationFiles(const NavigationGrid& grid, const LabelSet& labels,
                          const NavigationFiles& files);

}  // namespace csom
