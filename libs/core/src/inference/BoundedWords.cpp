// SPDX-License-Identifier: BSD-3-Clause
#include "inference/BoundedWords.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace csom::detail {

namespace {

/// Calls work(begin, end) for the increments of each voxel.
template <class Increments, class Work>
void forEachVoxel(Increments& increments, const Work& work) {
  for (auto begin = increments.begin(); begin != increments.end();) {
    const auto end = std::find_if(begin, increments.end(), [&](const CountIncrement& increment) {
      return increment.voxel != begin->voxel;
    });
    work(begin, end);
    begin = end;
  }
}

}  // namespace

void boundWords(ScanIncrements& scan) {
  for (ChunkIncrements& chunk : scan) {
    forEachVoxel(chunk.increments, [](auto begin, auto end) {
      std::uint64_t all = 0;
      for (auto i = begin; i != end; ++i) all += i->count;
      if (all <= kFullWord) return;
      for (auto i = begin; i != end; ++i)
        i->count =
            static_cast<std::uint32_t>((2 * std::uint64_t{kFullWord} * i->count + all) / (2 * all));
    });
    chunk.increments.erase(
        std::remove_if(chunk.increments.begin(), chunk.increments.end(),
                       [](const CountIncrement& increment) { return increment.count == 0; }),
        chunk.increments.end());
  }
}

void keepSurfaces(const ScanIncrements& surfaces, ScanIncrements& free) {
  std::vector<const ChunkIncrements*> by_chunk;
  by_chunk.reserve(surfaces.size());
  for (const ChunkIncrements& chunk : surfaces) by_chunk.push_back(&chunk);
  std::sort(by_chunk.begin(), by_chunk.end(),
            [](const auto* a, const auto* b) { return a->chunk < b->chunk; });
  for (ChunkIncrements& chunk : free) {
    const auto found = std::lower_bound(
        by_chunk.begin(), by_chunk.end(), chunk.chunk,
        [](const ChunkIncrements* one, const ChunkIndex& index) { return one->chunk < index; });
    if (found == by_chunk.end() || (*found)->chunk != chunk.chunk) continue;
    forEachVoxel((*found)->increments, [&](auto begin, auto end) {
      std::uint64_t of_free = 0;
      std::uint64_t of_others = 0;
      for (auto i = begin; i != end; ++i)
        (i->class_id == kFreeClass ? of_free : of_others) += i->count;
      const std::uint16_t voxel = begin->voxel;
      if (of_others > of_free)
        chunk.free.voxels[voxel >> 6U] &= ~(std::uint64_t{1} << (voxel & 63U));
    });
  }
}

}  // namespace csom::detail
