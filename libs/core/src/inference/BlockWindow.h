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

/// The blocks around a run of chunks along x, and where in the scan the points of each begin.
class BlockWindow {
 public:
  /// A row of blocks along x that holds points.
  struct Row {
    std::size_t offset;  ///< from the row it was asked for; see offsetOf()
    /// Block x, counted from the window's corner, has the points starts[x] … starts[x+1]−1.
    const std::uint32_t* starts;
  };

  /// The run is `length` blocks long and `edge` wide and high; the window reaches `reach` blocks
  /// beyond it on all sides. `edge` and `reach` must be the same in every call.
  void moveTo(const BlockRows& rows, const BlockIndex& corner, int length, int edge, int reach) {
    reach_ = reach;
    edge_ = edge;
    around_.resize(static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge));
    for (std::vector<Row>& list : around_) list.clear();
    const int span = edge + 2 * reach;
    const auto row_size = static_cast<std::size_t>(length + 2 * reach + 1);
    starts_.resize(static_cast<std::size_t>(span) * static_cast<std::size_t>(span) * row_size);
    std::uint32_t* starts = starts_.data();
    for (int z = -reach; z < edge + reach; ++z) {
      std::size_t cursor = rows.firstRow(corner.y - reach, corner.z + z);
      for (int y = -reach; y < edge + reach; ++y) {
        const BlockRows::Range row = rows.row(corner.y + y, corner.z + z, cursor);
        if (!fillRow(rows.scan(), row, corner.x - reach, row_size, starts)) continue;
        listRow(y, z, starts + reach);
        starts += row_size;
      }
    }
  }

  /// The rows with points at most `reach` from row (y, z) of the run, z-major.
  const std::vector<Row>& rowsAround(int y, int z) const {
    return around_[static_cast<std::size_t>(z * edge_ + y)];
  }
  /// Number of a row that lies at (y, z) from another.
  static std::size_t offsetOf(int y, int z, int reach) {
    return static_cast<std::size_t>((z + reach) * (2 * reach + 1) + (y + reach));
  }

 private:
  /// Returns false if no block of the row lies in the window.
  static bool fillRow(const PreparedScan& scan, const BlockRows::Range& row, std::int32_t first_x,
                      std::size_t row_size, std::uint32_t* starts) {
    const auto before = [](const BlockIndex& block, std::int32_t x) { return block.x < x; };
    const auto end = scan.blocks.begin() + static_cast<std::ptrdiff_t>(row.end);
    auto block = std::lower_bound(scan.blocks.begin() + static_cast<std::ptrdiff_t>(row.begin), end,
                                  first_x, before);
    const std::int32_t end_x = first_x + static_cast<std::int32_t>(row_size) - 1;
    if (block == end || block->x >= end_x) return false;
    const auto beginOf = [&](auto b) {
      return scan.block_begin[static_cast<std::size_t>(b - scan.blocks.begin())];
    };
    std::size_t x = 0;
    for (; block != end && block->x < end_x; ++block) {
      const auto block_x = static_cast<std::size_t>(block->x - first_x);
      while (x <= block_x) starts[x++] = beginOf(block);
    }
    while (x < row_size) starts[x++] = beginOf(block);
    return true;
  }

  /// Lists row (y, z) with all rows of the run that it lies around.
  void listRow(int y, int z, const std::uint32_t* starts) {
    for (int at_z = std::max(0, z - reach_); at_z <= std::min(edge_ - 1, z + reach_); ++at_z)
      for (int at_y = std::max(0, y - reach_); at_y <= std::min(edge_ - 1, y + reach_); ++at_y)
        around_[static_cast<std::size_t>(at_z * edge_ + at_y)].push_back(
            {offsetOf(y - at_y, z - at_z, reach_), starts});
  }

  int edge_ = 0;
  int reach_ = 0;
  std::vector<std::uint32_t> starts_;
  std::vector<std::vector<Row>> around_;  ///< of each row of the run, y first
};

}  // namespace csom::detail
