// SPDX-License-Identifier: BSD-3-Clause
// Blocks grouped by the chunk that they lie in: the pieces of work that threads take.
#pragma once

#include <csom/core/Grid.h>

#include <cstddef>
#include <vector>

#include "util/SortedKeys.h"

namespace csom::detail {

/// Blocks begin … end−1 of a list lie in this chunk, or may change it.
struct ChunkTask {
  ChunkIndex chunk;
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Sorts blocks by the chunk chunkOf(block), those of a chunk staying in order.
template <class Block, class ChunkOf>
std::vector<ChunkTask> groupByChunk(std::vector<Block>& blocks, const ChunkOf& chunkOf) {
  const auto sorted = sortedByPosition(blocks.size(), [&](std::size_t i) {
    const ChunkIndex c = chunkOf(blocks[i]);
    return KeyPacking::Position{c.x, c.y, c.z};
  });
  std::vector<Block> by_chunk;
  by_chunk.reserve(blocks.size());
  std::vector<ChunkTask> tasks;
  forEachRun(sorted, [&](std::size_t begin, std::size_t end) {
    tasks.push_back({chunkOf(blocks[sorted[begin].item]), begin, end});
    for (std::size_t i = begin; i < end; ++i) by_chunk.push_back(blocks[sorted[i].item]);
  });
  blocks.swap(by_chunk);
  return tasks;
}

/// Chunks close to each other along x share a window: tasks runs[i] … runs[i+1]−1.
inline std::vector<std::size_t> findRuns(const std::vector<ChunkTask>& tasks) {
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
