// SPDX-License-Identifier: BSD-3-Clause
// How much a scan says about places between its beams.
#pragma once

#include "inference/BoundedWords.h"
#include "util/Lanes.h"

namespace csom::detail {

/// 0.4/(1 + (d/1 m)²) of a full word at a distance d [m] from what was measured, to be rounded
/// down: of a number or a vector of lanes.
template <class Distance>
CSOM_INLINE Distance facetWeight(const Distance& distance) {
  return kPartOfWord * kFullWord / (1 + distance * distance) + 0.5F;
}

}  // namespace csom::detail
