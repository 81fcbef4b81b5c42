// SPDX-License-Identifier: BSD-3-Clause
// The beams of a range image, row by row, and what lies next to each of them.
#pragma once

#include <csom/core/RangeImage.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace csom::detail {

/// Number of a beam in the order of the image: by row, then by column.
using BeamId = std::int32_t;
constexpr BeamId kNoBeam = -1;

/// The points of a scan that have a pixel of their own, as beams in the order of the image.
///
/// Beside a beam in its row lies the next one if less than 1.6 column steps are between them, else
/// a beam is missing there. Above it lies the beam of the next row whose column is nearest, if it
/// is nearer than 0.8 column steps; below it that of the row before. Of two as near that without a
/// turn between comes first, then that of the lower column.
struct BeamNeighbours {
  void find(const RangeImage& image, int threads);

  std::size_t size() const { return point.size(); }

  std::vector<std::uint32_t> point;      ///< of each beam, its number in the scan
  std::vector<std::uint32_t> row_begin;  ///< rows + 1 positions among the beams
  std::vector<BeamId> next;              ///< in its row, or kNoBeam
  std::vector<BeamId> previous;
  std::vector<BeamId> above;
  std::vector<BeamId> below;

  // For finding them, kept for the next scan.
  std::vector<std::uint32_t> points;  ///< by row
  std::vector<std::int32_t> columns;  ///< of the beams
};

}  // namespace csom::detail
