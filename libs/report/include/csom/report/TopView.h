// SPDX-License-Identifier: BSD-3-Clause
// A picture of a map from above.
#pragma once

#include <csom/io/MapFile.h>

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace csom {

struct TopViewOptions {
  /// The direction that is up, in the map frame; the picture looks down the axis nearest to it.
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  /// Voxels whose centre is higher than this along `up` are left out [m].
  std::optional<double> highest;
  /// Classes that would hide everything below them.
  std::vector<std::string> hidden_classes{"ceiling"};
  /// Longest side of the map's part of the picture [pixels]. A large map shows several voxels in a
  /// pixel, a small one several pixels a voxel.
  int max_pixels = 1200;
};

/// Draws the topmost occupied voxel of every column in the colour of its class, shaded by height;
/// columns that are only free in light gray, unknown ones white. With z up, x points right and y to
/// the top. With a metric scale bar, the axes and a legend of the classes that the picture shows.
/// Returns the bytes of a PNG file; an empty map gives a picture that says so. Throws
/// std::invalid_argument if max_pixels is below 64 or above 4096.
std::vector<std::uint8_t> topViewPng(const MapDocument& document,
                                     const TopViewOptions& options = {});

}  // namespace csom
