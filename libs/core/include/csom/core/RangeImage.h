// SPDX-License-Identifier: BSD-3-Clause
// The image that a sensor takes: which beams of a scan are next to each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace csom {

/// Where the points of a scan lie in the range image of its sensor.
///
/// A row holds the beams of one ring of a rotating LiDAR, or of one line of a range camera, an
/// organised cloud. Rows are numbered in the order of their directions: nothing was measured
/// between row j and row j+1. Columns are positions along the rows, in steps as fine as the sensor
/// knows them (hundredths of a degree, or pixels): what has the same column in two rows lies side
/// by side. The first row may be at the top or at the bottom, columns may run to either side.
///
/// Beams that returned nothing have no point; their pixels are empty. prepareScan() refuses an
/// image with another number of pixels than points, a column step below 1 or a column outside its
/// turn.
struct RangeImage {
  /// Where a point lies. A row of kNoRow: nowhere. If several points name the same pixel, the
  /// first one has it. Points without a pixel count as hits, but nothing lies next to them.
  struct Pixel {
    std::uint16_t row = kNoRow;
    std::int32_t column = 0;

    friend bool operator==(const Pixel& a, const Pixel& b) {
      return a.row == b.row && a.column == b.column;
    }
  };
  static constexpr std::uint16_t kNoRow = 0xffff;

  std::vector<Pixel> pixels;     ///< one a point; empty: the scan has no image
  std::int32_t column_step = 1;  ///< between adjacent beams of a row, at least 1
  /// Columns of a full turn: the last ones lie beside the first ones, and all are from 0 to one
  /// less than this. 0: the image has a left and a right border.
  std::int32_t columns_of_turn = 0;

  bool empty() const { return pixels.empty(); }
};

}  // namespace csom
