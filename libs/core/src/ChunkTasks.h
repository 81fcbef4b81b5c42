// SPDX-License-Identifier: BSD-3-Clause
// Blocks grouped by the chunk that they lie in: the pieces of work that threads take.
#pragma once

#include <csom/core/ContextEntropy.h>
#include <csom/core/Grid.h>

#include <cstddef>
#include <vector>

#include "SortedKeys.h"

namespace csom::detail {

/// Blocks begin … end−1 of a list lie in this chunk, or matter to it.
struct ChunkTask {
  ChunkIndex chunk;
  std::size_t begin = 0;
  std::size_t end = 0;
};

inline ChunkIndex chunkOfBlock(const BlockIndex& b, int block_depth) {
  const int shift = kChunkBits - (block_depth - 1);
  return {b.x >> shift, b.y >> shift, b.z >> shift};
}

/// Sorts blocks by chunk, those of a chunk staying in order.
inline std::vector<ChunkTask> groupByChunk(std::vector<FilledBlock>& blocks, int block_depth) {
  const auto sorted = sortedByPosition(blocks.size(), [&](std::size_t i) {
    const ChunkIndex c = chunkOfBlock(blocks[i].index, block_depth);
    return KeyPacking::Position{c.x, c.y, c.z};
  });
  std::vector<FilledBlock> by_chunk;
  by_chunk.reserve(blocks.size());
  std::vector<ChunkTask> tasks;
  forEachRun(sorted, [&](std::size_t begin, std::size_t end) {
    tasks.push_back({chunkOfBlock(blocks[sorted[begin].item].index, block_depth), begin, end});
    for (std::size_t i = begin; i < end; ++i) by_chunk.push_back(blocks[sorted[i].item]);
  });
  blocks.swap(by_chunk);
  return tasks;
}

/// Chunks close to each other along x share a window: tasks runs[i] … runs[i+1]−1.
inline std::vector<std::size_t> runsOf(const std::vector<ChunkTask>& tasks) {
  constexpr std::int32_t kLargestStep = 2;
  std::vector<std::size_t> runs;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const ChunkIndex& chunk = tasks[i].chunk;
    const ChunkIndex& before = tasks[i > 0 ? i - 1 : 0].chunk;
    if (i == 0 || chunk.y != before.y || chunk.z != before.z || chunk.x - before.x > kLargestStep)
      runs.push_back(i);
  }
  runs.push_back(tasks.size());
  return runs;
}

}  // namespace csom::detail
