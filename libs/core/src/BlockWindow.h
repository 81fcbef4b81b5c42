// SPDX-License-Identifier: BSD-3-Clause
// The training points around a chunk, found by block in constant time.
#pragma once

#include <csom/core/ScanPreparation.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "Lanes.h"

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

/// A cube of blocks with copies of its points, each coordinate in an array of its own, in voxels
/// from the lower corner of the chunk in its middle.
class BlockWindow {
 public:
  /// The cube reaches from `reach` blocks below `chunk_corner` to `reach` blocks beyond the
  /// `chunk_edge` blocks of the chunk. A block is `block_side` voxels a side. All but the corner
  /// must be the same in every call; going on to a chunk with greater x alone is cheapest.
  void moveTo(const BlockRows& rows, const BlockIndex& chunk_corner, int chunk_edge, int reach,
              int block_side) {
    const bool goes_on = !remaining_.empty() && chunk_corner.y == corner_.y &&
                         chunk_corner.z == corner_.z && chunk_corner.x > corner_.x;
    corner_ = chunk_corner;
    edge_ = chunk_edge + 2 * reach;
    reach_ = reach;
    if (!goes_on) findRows(rows);
    size_ = 0;
    for (int z = 0; z < edge_; ++z)
      for (int y = 0; y < edge_; ++y) copyRow(rows.scan(), y, z, block_side);
  }

  /// Block (x, y, z) of the chunk, counted from its lower corner and at most `reach` beyond it, has
  /// the points starts[0] … starts[1]−1; starts continues along x.
  const std::uint32_t* startsAt(int x, int y, int z) const {
    return starts_.data() + rowOffset(y + reach_, z + reach_) + (x + reach_);
  }
  /// startsAt(a + b) − startsAt(a).
  std::ptrdiff_t stride(int x, int y, int z) const { return rowOffset(y, z) + x; }

  const float* x() const { return x_.data(); }
  const float* y() const { return y_.data(); }
  const float* z() const { return z_.data(); }
  /// Position in PreparedScan::points.
  const std::uint32_t* point() const { return point_.data(); }

 private:
  std::ptrdiff_t rowOffset(int y, int z) const {
    return (static_cast<std::ptrdiff_t>(z) * edge_ + y) * (edge_ + 1);
  }

  void findRows(const BlockRows& rows) {
    const auto edge = static_cast<std::size_t>(edge_);
    starts_.resize(edge * edge * (edge + 1));
    remaining_.clear();
    for (int z = 0; z < edge_; ++z) {
      std::size_t cursor = rows.firstRow(corner_.y - reach_, corner_.z + z - reach_);
      for (int y = 0; y < edge_; ++y)
        remaining_.push_back(rows.row(corner_.y + y - reach_, corner_.z + z - reach_, cursor));
    }
  }

  void copyRow(const PreparedScan& scan, int y, int z, int block_side) {
    const std::int32_t first_x = corner_.x - reach_;
    BlockRows::Range& row = remaining_[static_cast<std::size_t>(z * edge_ + y)];
    while (row.begin < row.end && scan.blocks[row.begin].x < first_x) ++row.begin;
    std::uint32_t* const starts = starts_.data() + rowOffset(y, z);
    const auto offset_y = static_cast<float>((y - reach_) * block_side);
    const auto offset_z = static_cast<float>((z - reach_) * block_side);
    int x = 0;
    for (std::size_t b = row.begin; b < row.end && scan.blocks[b].x < first_x + edge_; ++b) {
      const int block_x = scan.blocks[b].x - first_x;
      while (x <= block_x) starts[x++] = static_cast<std::uint32_t>(size_);
      const auto offset_x = static_cast<float>((block_x - reach_) * block_side);
      reserve(size_ + scan.block_begin[b + 1] - scan.block_begin[b]);
      for (std::uint32_t i = scan.block_begin[b]; i < scan.block_begin[b + 1]; ++i, ++size_) {
        const TrainingPoint& p = scan.points[i];
        x_[size_] = p.x + offset_x;
        y_[size_] = p.y + offset_y;
        z_[size_] = p.z + offset_z;
        point_[size_] = i;
      }
    }
    while (x <= edge_) starts[x++] = static_cast<std::uint32_t>(size_);
  }

  /// Whole vectors are read, also beyond the last point.
  void reserve(std::size_t size) {
    if (size + kLanes <= x_.size()) return;
    for (std::vector<float>* axis : {&x_, &y_, &z_}) axis->resize(2 * size + kLanes);
    point_.resize(2 * size + kLanes);
  }

  BlockIndex corner_;
  int edge_ = 0;
  int reach_ = 0;
  std::vector<BlockRows::Range> remaining_;  ///< of each row, the blocks not yet passed
  std::size_t size_ = 0;
  std::vector<std::uint32_t> starts_;
  std::vector<float> x_, y_, z_;
  std::vector<std::uint32_t> point_;
};

}  // namespace csom::detail
