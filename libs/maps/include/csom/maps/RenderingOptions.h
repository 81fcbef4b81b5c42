// SPDX-License-Identifier: BSD-3-Clause
// What 3-D views show of a map.
#pragma once

#include <csom/core/EnumWords.h>
#include <csom/core/OptionInfo.h>

namespace csom {

/// What the colour of an occupied voxel says. Class: the colour of its most likely class.
/// Probability: that of this class, from blue (0) to red (1). Height: from blue, the lowest voxel,
/// to red, the highest.
enum class VoxelColor { Class, Probability, Height };

template <>
inline constexpr EnumWords<VoxelColor, 3> kWords<VoxelColor>{
    {{VoxelColor::Class, "class"},
     {VoxelColor::Probability, "probability"},
     {VoxelColor::Height, "height"}}};

struct RenderingOptions {
  VoxelColor color_by = VoxelColor::Class;
  bool visible_only = true;  ///< leaves out voxels that others of their kind hide on all six sides
  bool occupied_voxels = true;
  bool free_voxels = false;
  bool unknown_voxels = false;  ///< those that touch free ones with a side: where knowledge ends
  bool save_scene = false;      ///< saving a map also writes what views show

  template <class Self, class Visitor>
  static void visit(Self& o, Visitor&& visitor) {
    visitor(OptionInfo{"color_by", "",
                       "what the colour of occupied voxels says: their `class`, its `probability` "
                       "from blue (0) "
                       "to red (1), or `height` from blue (lowest) to red (highest)"},
            o.color_by);
    visitor(OptionInfo{"visible_only", "",
                       "leaves out voxels that others of their kind hide on all six sides"},
            o.visible_only);
    visitor(OptionInfo{"occupied_voxels", "", "shows occupied voxels"}, o.occupied_voxels);
    visitor(OptionInfo{"free_voxels", "", "shows free voxels, faintly"}, o.free_voxels);
    visitor(OptionInfo{"unknown_voxels", "",
                       "shows, faintly, unknown voxels that touch free ones: where knowledge ends"},
            o.unknown_voxels);
    visitor(
        OptionInfo{
            "save_scene", "",
            "where a program saves the map, a .3Dscene for SceneViewer3D is written beside it"},
        o.save_scene);
  }
};

}  // namespace csom
