// SPDX-License-Identifier: BSD-3-Clause
// How much a scan says about places between its beams.
#pragma once

#include <cstdint>

#include "image/VoxelWords.h"

namespace csom::detail {

/// Of a facet beside its ends.
constexpr float kFacetWeight = 0.4F * kFullWord;

/// 0.4/(1 + (d/1 m)²) of a full word, rounded: at a distance d [m] from what was measured.
inline std::uint32_t facetWeight(float distance) {
  return static_cast<std::uint32_t>(kFacetWeight / (1 + distance * distance) + 0.5F);
}

}  // namespace csom::detail
