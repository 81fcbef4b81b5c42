// SPDX-License-Identifier: BSD-3-Clause
// What a scan adds to a map: integer counts of classes, by chunk, voxel and class.
#pragma once

#include <csom/core/types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace csom {

/// Count of one class of one voxel, in quanta (see kCountQuantum); never 0.
struct CountIncrement {
  std::uint16_t voxel;  ///< indexInChunk()
  ClassId class_id;
  std::uint32_t count;
};

/// Voxels of a chunk, a bit each, that all receive the same count of class 0.
struct FreeIncrements {
  std::array<std::uint64_t, 8> voxels{};
  std::uint32_t count = 0;  ///< in quanta; 0: no voxel receives any

  bool empty() const { return count == 0; }
};

/// The increments of one chunk, sorted by (voxel, class), each pair at most once. Of voxels that
/// are free as well, there are none of class 0.
struct ChunkIncrements {
  ChunkIndex chunk;
  std::vector<CountIncrement> increments;
  FreeIncrements free = {};

  bool empty() const { return increments.empty() && free.empty(); }
};

/// Each chunk at most once, in any order.
using ScanIncrements = std::vector<ChunkIncrements>;

}  // namespace csom
