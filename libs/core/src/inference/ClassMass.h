// SPDX-License-Identifier: BSD-3-Clause
// How much of each class the points of a block carry.
#pragma once

#include <csom/core/ScanPreparation.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace csom::detail {

/// Sets `mass`, one element a class, to the class mass of the points of an observed block.
inline void sumClassMass(const PreparedScan& scan, std::size_t block, std::vector<double>& mass) {
  std::fill(mass.begin(), mass.end(), 0.0);
  for (std::size_t i = scan.block_begin[block]; i < scan.block_begin[block + 1]; ++i) {
    if (scan.scores.empty()) {
      mass[scan.points[i].label] += 1;
    } else {
      for (std::size_t k = 0; k < mass.size(); ++k)
        mass[k] += static_cast<double>(scan.scores[i * mass.size() + k]);
    }
  }
}

}  // namespace csom::detail
