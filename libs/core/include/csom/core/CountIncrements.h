// SPDX-License-Identifier: BSD-3-Clause
// What a scan adds to a map: integer counts of classes, by chunk, voxel and class.
#pragma once

#include <csom/core/types.h>

#include <cstdint>
#include <vector>

namespace csom {

/// Count of one class of one voxel, in quanta (see kCountQuantum); never 0.
struct CountIncrement {
  std::uint16_t voxel;  ///< indexInChunk()
  ClassId class_id;
  std::uint32_t count;
};

/// The increments of one chunk, sorted by (voxel, class), each pair at most once.
struct ChunkIncrements {
  ChunkIndex chunk;
  std::vector<CountIncrement> increments;
};

/// Each chunk at most once, in any order.
using ScanIncrements = std::vector<ChunkIncrements>;

}  // namespace csom
