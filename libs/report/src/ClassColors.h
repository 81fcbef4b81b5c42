// SPDX-License-Identifier: BSD-3-Clause
// In which colours pictures show the classes of a map.
#pragma once

#include <csom/io/MapFile.h>

#include <vector>

namespace csom {

/// By class id: the colours of the label set.
std::vector<Color> labelColors(const MapDocument& document);

/// By class id: colours that people with colour-blind eyes tell apart, the clearest ones for the
/// classes with the most voxels. Two of the classes beyond the first 21 may have the same.
std::vector<Color> colorBlindSafeColors(const MapDocument& document);

}  // namespace csom
