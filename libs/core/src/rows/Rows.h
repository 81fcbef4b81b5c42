// SPDX-License-Identifier: BSD-3-Clause
// Which beams of a cloud form a row.
#pragma once

#include <csom/core/RangeImage.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "rows/Directions.h"

namespace csom::detail {

/// The row of each beam, numbered from 0; kInNoRow for those that fit into none.
struct Rows {
  static constexpr std::uint16_t kInNoRow = RangeImage::kNoRow;

  std::vector<std::uint16_t> of_beam;
  std::size_t count = 0;
};

/// Limits of what is taken for a scan.
constexpr std::size_t kFewestRows = 4;
constexpr std::size_t kMostRows = 512;
constexpr std::size_t kFewestBeamsOfRow = 16;

/// Rows that were written down one after the other: the azimuth runs round once in each. Where one
/// ends shows where the azimuth goes back, as lasers of a row look a little aside, or where the
/// elevation jumps. Nothing if azimuths do not run round like that.
std::optional<Rows> findRowsInOrder(const Directions& beams);

/// Rows whose beams have one elevation, in any order. Nothing if elevations are not few.
std::optional<Rows> findRowsByElevation(const Directions& beams);

/// Numbers the rows by their elevations and leaves out those of less than kFewestBeamsOfRow beams.
/// False if they are none: too few or too many, less than nine in ten beams in rows, or rows that
/// lie over one another, as those of several turns do.
bool arrange(const Directions& beams, Rows& rows);

}  // namespace csom::detail
