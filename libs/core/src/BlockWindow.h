// SPDX-License-Identifier: BSD-3-Clause
// The training points around a chunk, found by block in constant time.
#pragma once

#include <csom/core/ScanPreparation.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace csom::detail {

/// Rows of observed blocks along x: blocks are sorted z-major, so a row and its points are
/// contiguous.
class BlockRows {
 public:
  explicit BlockRows(const PreparedScan& scan) : scan_(&scan) {
    for (std::size_t i = 0; i < scan.blocks.size(); ++i) {
      const BlockIndex& b = scan.blocks[i];
      if (rows_.empty() || rows_.back().y != b.y || rows_.back().z != b.z)
        rows_.push_back({b.z, b.y, static_cast<std::uint32_t>(i)});
    }
  }

  /// Writes, for x = x_begin … x_begin+size, the offset of the first point of row (y, z) whose
  /// block is at x or beyond: block x has the points starts[x−x_begin] … starts[x−x_begin+1]−1.
  /// `cursor` remembers where the previous row was, so that ascending y costs no search.
  void pointStarts(std::int32_t x_begin, std::int32_t y, std::int32_t z, int size,
                   std::size_t& cursor, std::uint32_t* starts) const {
    while (cursor < rows_.size() &&
           (rows_[cursor].z < z || (rows_[cursor].z == z && rows_[cursor].y < y)))
      ++cursor;
    if (cursor == rows_.size() || rows_[cursor].z != z || rows_[cursor].y != y) {
      std::fill(starts, starts + size + 1, 0U);
      return;
    }
    const auto begin = scan_->blocks.begin() + rows_[cursor].first_block;
    const auto end = cursor + 1 < rows_.size()
                         ? scan_->blocks.begin() + rows_[cursor + 1].first_block
                         : scan_->blocks.end();
    auto block = std::lower_bound(begin, end, x_begin,
                                  [](const BlockIndex& b, std::int32_t x) { return b.x < x; });
    for (int i = 0; i <= size; ++i) {
      while (block != end && block->x < x_begin + i) ++block;
      starts[i] = scan_->block_begin[static_cast<std::size_t>(block - scan_->blocks.begin())];
    }
  }

  /// The first row at or after (y, z): where a cursor starts.
  std::size_t firstRow(std::int32_t y, std::int32_t z) const {
    const auto row = std::lower_bound(
        rows_.begin(), rows_.end(), Row{z, y, 0},
        [](const Row& a, const Row& b) { return a.z != b.z ? a.z < b.z : a.y < b.y; });
    return static_cast<std::size_t>(row - rows_.begin());
  }

 private:
  struct Row {
    std::int32_t z;
    std::int32_t y;
    std::uint32_t first_block;
  };
  const PreparedScan* scan_;
  std::vector<Row> rows_;
};

/// The offsets of the points of every block in a cube of blocks.
class BlockWindow {
 public:
  /// The cube's lower corner and its edge, in blocks.
  void moveTo(const BlockRows& rows, const BlockIndex& corner, int edge) {
    corner_ = corner;
    edge_ = edge;
    starts_.resize(static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge) *
                   static_cast<std::size_t>(edge + 1));
    for (int z = 0; z < edge; ++z) {
      std::size_t cursor = rows.firstRow(corner.y, corner.z + z);
      for (int y = 0; y < edge; ++y)
        rows.pointStarts(corner.x, corner.y + y, corner.z + z, edge, cursor,
                         starts_.data() + rowOffset(y, z));
    }
  }

  /// starts[0] … starts[1]−1 are the points of block (x, y, z); starts continues along x.
  const std::uint32_t* pointsOf(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return starts_.data() + rowOffset(y - corner_.y, z - corner_.z) + (x - corner_.x);
  }

 private:
  std::ptrdiff_t rowOffset(int y, int z) const {
    return (static_cast<std::ptrdiff_t>(z) * edge_ + y) * (edge_ + 1);
  }

  BlockIndex corner_;
  int edge_ = 0;
  std::vector<std::uint32_t> starts_;
};

}  // namespace csom::detail
