// SPDX-License-Identifier: BSD-3-Clause
// The training points around a chunk, found by block in constant time.
#pragma once

#include <csom/core/ScanPreparation.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace csom::detail {

/// Rows of observed blocks along x: blocks are sorted z-major, so a row is contiguous.
class BlockRows {
 public:
  struct Range {
    std::size_t begin = 0;  ///< blocks begin … end−1 of PreparedScan::blocks
    std::size_t end = 0;
  };

  explicit BlockRows(const PreparedScan& scan) : scan_(&scan) {
    for (std::size_t i = 0; i < scan.blocks.size(); ++i) {
      const BlockIndex& b = scan.blocks[i];
      if (rows_.empty() || rows_.back().y != b.y || rows_.back().z != b.z)
        rows_.push_back({b.z, b.y, i});
    }
  }

  const PreparedScan& scan() const { return *scan_; }

  /// The first row at or after (y, z): where a cursor starts.
  std::size_t firstRow(std::int32_t y, std::int32_t z) const {
    const auto row = std::lower_bound(
        rows_.begin(), rows_.end(), Row{z, y, 0},
        [](const Row& a, const Row& b) { return a.z != b.z ? a.z < b.z : a.y < b.y; });
    return static_cast<std::size_t>(row - rows_.begin());
  }

  /// The blocks of row (y, z). `cursor` remembers where the previous row was, so that ascending y
  /// costs no search.
  Range row(std::int32_t y, std::int32_t z, std::size_t& cursor) const {
    while (cursor < rows_.size() &&
           (rows_[cursor].z < z || (rows_[cursor].z == z && rows_[cursor].y < y)))
      ++cursor;
    if (cursor == rows_.size() || rows_[cursor].z != z || rows_[cursor].y != y) return {};
    return {rows_[cursor].first_block,
            cursor + 1 < rows_.size() ? rows_[cursor + 1].first_block : scan_->blocks.size()};
  }

 private:
  struct Row {
    std::int32_t z;
    std::int32_t y;
    std::size_t first_block;
  };
  const PreparedScan* scan_;
  std::vector<Row> rows_;
};

/// A cube of blocks, and where in the scan the points of each begin.
class BlockWindow {
 public:
  /// The cube reaches from `reach` blocks below `chunk_corner` to `reach` blocks beyond the
  /// `chunk_edge` blocks of the chunk. All but the corner must be the same in every call; going on
  /// to a chunk with greater x alone is cheapest.
  void moveTo(const BlockRows& rows, const BlockIndex& chunk_corner, int chunk_edge, int reach) {
    const bool goes_on = !remaining_.empty() && chunk_corner.y == corner_.y &&
                         chunk_corner.z == corner_.z && chunk_corner.x > corner_.x;
    corner_ = chunk_corner;
    edge_ = chunk_edge + 2 * reach;
    reach_ = reach;
    if (!goes_on) findRows(rows);
    for (int z = 0; z < edge_; ++z)
      for (int y = 0; y < edge_; ++y) fillRow(rows.scan(), y, z);
  }

  /// Whether there is any point in row (y, z) of blocks; see startsAt(). Mostly there is not.
  const std::uint8_t* observedAt(int y, int z) const {
    return observed_.data() + rowStride(y + reach_, z + reach_);
  }
  /// observedAt(a + b) − observedAt(a).
  std::ptrdiff_t rowStride(int y, int z) const {
    return static_cast<std::ptrdiff_t>(z) * edge_ + y;
  }
  /// Block (x, y, z) of the chunk, counted from its lower corner and at most `reach` beyond it, has
  /// the points starts[0] … starts[1]−1 of the scan, if its row is observed; starts continues along
  /// x.
  const std::uint32_t* startsAt(int x, int y, int z) const {
    return starts_.data() + rowOffset(y + reach_, z + reach_) + (x + reach_);
  }
  /// startsAt(a + b) − startsAt(a).
  std::ptrdiff_t stride(int x, int y, int z) const { return rowOffset(y, z) + x; }

 private:
  std::ptrdiff_t rowOffset(int y, int z) const { return rowStride(y, z) * (edge_ + 1); }

  void findRows(const BlockRows& rows) {
    const auto edge = static_cast<std::size_t>(edge_);
    starts_.resize(edge * edge * (edge + 1));
    observed_.resize(edge * edge);
    remaining_.clear();
    for (int z = 0; z < edge_; ++z) {
      std::size_t cursor = rows.firstRow(corner_.y - reach_, corner_.z + z - reach_);
      for (int y = 0; y < edge_; ++y)
        remaining_.push_back(rows.row(corner_.y + y - reach_, corner_.z + z - reach_, cursor));
    }
  }

  void fillRow(const PreparedScan& scan, int y, int z) {
    const std::int32_t first_x = corner_.x - reach_;
    BlockRows::Range& row = remaining_[static_cast<std::size_t>(z * edge_ + y)];
    while (row.begin < row.end && scan.blocks[row.begin].x < first_x) ++row.begin;
    const bool observed = row.begin < row.end && scan.blocks[row.begin].x < first_x + edge_;
    observed_[static_cast<std::size_t>(rowStride(y, z))] = observed ? 1 : 0;
    if (!observed) return;
    std::uint32_t* const starts = starts_.data() + rowOffset(y, z);
    int x = 0;
    std::size_t b = row.begin;
    for (; b < row.end && scan.blocks[b].x < first_x + edge_; ++b) {
      const int block_x = scan.blocks[b].x - first_x;
      while (x <= block_x) starts[x++] = scan.block_begin[b];
    }
    while (x <= edge_) starts[x++] = scan.block_begin[b];
  }

  BlockIndex corner_;
  int edge_ = 0;
  int reach_ = 0;
  std::vector<BlockRows::Range> remaining_;  ///< of each row, the blocks not yet passed
  std::vector<std::uint8_t> observed_;       ///< of each row, whether starts_ is filled
  std::vector<std::uint32_t> starts_;
};

}  // namespace csom::detail
