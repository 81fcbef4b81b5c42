// SPDX-License-Identifier: BSD-3-Clause
// A map as one sees it from obliquely above, all axes at the same scale.
#pragma once

#include <csom/io/MapFile.h>

#include <optional>
#include <vector>

#include "ColumnGrid.h"
#include "DrawnMap.h"
#include "ViewAxes.h"

namespace csom {

/// From behind, from the left and from above of one who stands in the map. `colors`: by class id.
/// Nothing if the filter leaves no occupied voxel.
std::optional<DrawnMap> drawIsometric(const SemanticMap& map, const ViewAxes& axes,
                                      const VoxelFilter& filter, const std::vector<Color>& colors,
                                      int max_pixels);

}  // namespace csom
