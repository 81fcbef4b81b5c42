// SPDX-License-Identifier: BSD-3-Clause
// The blocks of an extended block: the block itself and its 6, 18 or 26 neighbours.
#pragma once

#include <cstdlib>
#include <vector>

namespace csom::detail {

struct BlockOffset {
  int x, y, z;
  /// 0 the block itself, 1 a face, 2 an edge, 3 a corner neighbour.
  int kind() const { return std::abs(x) + std::abs(y) + std::abs(z); }
};

/// Ascending (z-major). `neighbours` is 6, 18 or 26.
inline std::vector<BlockOffset> extendedBlock(int neighbours) {
  const int farthest_kind = neighbours == 6 ? 1 : neighbours == 18 ? 2 : 3;
  std::vector<BlockOffset> offsets;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const BlockOffset offset{x, y, z};
        if (offset.kind() <= farthest_kind) offsets.push_back(offset);
      }
  return offsets;
}

}  // namespace csom::detail
