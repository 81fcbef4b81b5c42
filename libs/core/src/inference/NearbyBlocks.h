// SPDX-License-Identifier: BSD-3-Clause
// Which blocks around a block may hold points nearer than a length.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "inference/BlockWindow.h"
#include "inference/KernelMass.h"

namespace csom::detail {

/// By how many blocks along x, on both sides, each row around a block matters to it; −1 if it does
/// not. See BlockWindow::offsetOf().
using HalfWidths = std::vector<int>;

/// Not thread-safe: it remembers the lengths that it was asked for.
class NearbyBlocks {
 public:
  /// What looks around lies at least `inset` voxels inside its block: ½ for voxel centres, 0 for
  /// points. `reach` in blocks, `block_side` in voxels.
  NearbyBlocks(int block_side, int reach, float inset) : reach_(reach) {
    for (int offset = 0; offset <= reach; ++offset) {
      const float gap = offset == 0 ? 0.0F : static_cast<float>((offset - 1) * block_side) + inset;
      gaps_squared_.push_back(gap * gap);
    }
  }

  /// Blocks that a length can reach, at least one.
  static int reachOf(float length, int block_side, float inset) {
    return std::max(1,
                    static_cast<int>(std::ceil((length - inset) / static_cast<float>(block_side))));
  }

  /// Lengths share their widths by quarters of a voxel, rounded up: points too far are sorted out
  /// later.
  const HalfWidths& within(float length) {
    constexpr float kSteps = 4;
    const auto step = static_cast<std::size_t>(std::ceil(length * kSteps));
    if (by_length_.size() <= step) by_length_.resize(step + 1);
    HalfWidths& found = by_length_[step];
    if (!found.empty()) return found;
    const float longest = static_cast<float>(step) / kSteps;
    const float limit = longest * longest;
    for (int z = -reach_; z <= reach_; ++z)
      for (int y = -reach_; y <= reach_; ++y) {
        int x = -1;
        while (x < reach_ && gapSquared(x + 1) + gapSquared(y) + gapSquared(z) < limit) ++x;
        found.push_back(x);
      }
    return found;
  }

 private:
  /// Square of the least distance along one axis to a block so many blocks away.
  float gapSquared(int offset) const {
    return gaps_squared_[static_cast<std::size_t>(std::abs(offset))];
  }

  int reach_;
  std::vector<float> gaps_squared_;
  std::vector<HalfWidths> by_length_;
};

/// The ranges of points in these blocks around a block of the window, z-major by block. Free of
/// branches inside: which rows hold points so near cannot be foreseen.
inline void listRanges(const BlockWindow& window, const BlockIndex& block,
                       const HalfWidths& half_widths, std::vector<PointRange>& ranges) {
  const std::vector<BlockWindow::Row>& rows = window.rowsAround(block.y, block.z);
  ranges.resize(rows.size() + 1);
  PointRange* next = ranges.data();
  for (const BlockWindow::Row& row : rows) {
    // A row that does not matter, −1 wide, begins behind its end.
    const int half_width = half_widths[row.offset];
    *next = {row.starts[block.x - half_width], row.starts[block.x + half_width + 1]};
    next += next->first < next->last ? 1 : 0;
  }
  ranges.resize(static_cast<std::size_t>(next - ranges.data()));
}

}  // namespace csom::detail
