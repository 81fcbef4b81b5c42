// SPDX-License-Identifier: BSD-3-Clause
// What 3-D views show of a map.
#pragma once

#include <string>

namespace csom {

/// What the colour of an occupied voxel says. Class: the colour of its most likely class.
/// Probability: that of this class, from blue (0) to red (1). Height: from blue, the lowest voxel,
/// to red, the highest.
enum class VoxelColor { Class, Probability, Height };

std::string toString(VoxelColor value);
/// Throws OptionError with the accepted words.
void parse(const std::string& key, const std::string& text, VoxelColor& value);

struct RenderingOptions {
  VoxelColor color_by = VoxelColor::Class;
  bool visible_only = true;  ///< leaves out voxels that others of their kind hide on all six sides
  bool occupied_voxels = true;
  bool free_voxels = false;
  bool unknown_voxels = false;  ///< those that touch free ones with a side: where knowledge ends
  bool save_scene = false;      ///< saving a map also writes what views show
};

/// Calls `visitor(key, field, unit, help)` for every field, in order.
template <class RenderingOptionsLike, class Visitor>
void visitRenderingOptions(RenderingOptionsLike&& o, Visitor&& visitor) {
  visitor("color_by", o.color_by, "",
          "what the colour of occupied voxels says: their `class`, its `probability` from blue (0) "
          "to red (1), or `height` from blue (lowest) to red (highest)");
  visitor("visible_only", o.visible_only, "",
          "leaves out voxels that others of their kind hide on all six sides");
  visitor("occupied_voxels", o.occupied_voxels, "", "shows occupied voxels");
  visitor("free_voxels", o.free_voxels, "", "shows free voxels, faintly");
  visitor("unknown_voxels", o.unknown_voxels, "",
          "shows, faintly, unknown voxels that touch free ones: where knowledge ends");
  visitor("save_scene", o.save_scene, "",
          "where a program saves the map, a .3Dscene for SceneViewer3D is written beside it");
}

}  // namespace csom
