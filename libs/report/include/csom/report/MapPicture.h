// SPDX-License-Identifier: BSD-3-Clause
// Pictures of a map, drawn without a display.
#pragma once

#include <csom/io/MapFile.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace csom {

/// From above; two elevations, which look along the second and against the first axis of the
/// ground; and from obliquely above, all three axes at the same scale.
enum class MapView { Top, Front, Side, Isometric };
inline constexpr std::array kMapViews{MapView::Top, MapView::Isometric, MapView::Front,
                                      MapView::Side};
/// "top", …
const char* toString(MapView view);

struct MapPictureOptions {
  /// The direction that is up, in the map frame; pictures take the axis nearest to it for it.
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  /// Voxels whose centre is higher than this along `up` are left out [m].
  std::optional<double> highest;
  /// Classes that would hide everything below them.
  std::vector<std::string> hidden_classes{"ceiling"};
  /// Longest side of the map's part of the picture [pixels]. A large map shows several voxels in a
  /// pixel, a small one several pixels a voxel.
  int max_pixels = 1200;
  /// Not the colours of the label set, but ones that people with colour-blind eyes tell apart.
  bool color_blind_safe = false;
};

/// Draws the occupied voxels that one sees from there in the colours of their classes, nearer ones
/// lighter; where one sees none, what is known to be free in light gray (not in the isometric view)
/// and what is unknown white. With z up, x points right and y to the top of the top view. With a
/// metric scale bar, the axes and a legend of the classes that the picture shows. Returns the bytes
/// of a PNG file; an empty map gives a picture that says so. Throws std::invalid_argument if
/// max_pixels is below 64 or above 4096.
std::vector<std::uint8_t> mapPicturePng(const MapDocument& document, MapView view,
                                        const MapPictureOptions& options = {});

}  // namespace csom
