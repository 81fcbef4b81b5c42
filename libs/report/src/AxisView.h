// SPDX-License-Identifier: BSD-3-Clause
// A map as one sees it along one of its axes.
#pragma once

#include <csom/io/MapFile.h>

#include <optional>
#include <vector>

#include "ColumnGrid.h"
#include "DrawnMap.h"

namespace csom {

/// `colors`: by class id. Nothing if the filter leaves no voxel.
std::optional<DrawnMap> drawAlongAxis(const SemanticMap& map, const Sight& sight,
                                      const VoxelFilter& filter, const std::vector<Color>& colors,
                                      int max_pixels);

}  // namespace csom
