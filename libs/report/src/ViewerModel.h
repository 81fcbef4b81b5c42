// SPDX-License-Identifier: BSD-3-Clause
// The occupied voxels of a map as the page's viewer (web/voxels.js) reads them.
#pragma once

#include <csom/io/MapFile.h>
#include <csom/report/RunRecord.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace csom {

/// Lengths are in cubes, that is voxels unless the map has too many of them.
struct ViewerModel {
  std::size_t cubes = 0;
  int voxels_per_cube = 1;  ///< along an edge: 1, 2, 4 or 8
  /// JSON: `resolution` (edge of a cube [m]), `tiles`, `voxels` (cubes), `vectorEntries`,
  /// `voxelsPerCube`, `up` {axis, sign}, `focus` {low, high} (the box of most cubes), `layers`
  /// {low, high} (indices along up), `classes` (those that occur, the largest first; `shown`: at
  /// first), `classNames` (all, by id, with `color` and `safeColor` for colour-blind eyes),
  /// `variance` and `evidence` {min, max}, `trajectories` (a list of points a sensor).
  std::string header;
  /// zlib stream of: i32[3·tiles] indices of the tiles of 32×32×32 cubes; u32[1024·tiles] their
  /// cubes, bit x of word 32·z + y; and for each cube in this order u8 length of its class vector,
  /// u8 variance, u8 evidence (both logarithmic from min to max); then of all class vectors, the
  /// most likely class first, u8 the classes and u8 the probabilities · 255. Little-endian.
  std::vector<std::uint8_t> data;
};

/// Of more than `most_cubes` voxels, or of ones that are scattered over too many tiles, cubes of
/// 2×2×2 or more show the one of most evidence each.
ViewerModel viewerModel(const MapDocument& document, const RunRecord& record,
                        std::size_t most_cubes = 1'500'000);

}  // namespace csom
