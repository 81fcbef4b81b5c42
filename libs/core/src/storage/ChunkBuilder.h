// SPDX-License-Identifier: BSD-3-Clause
// The only code that writes into chunks.
#pragma once

#include <csom/core/Chunk.h>
#include <csom/core/CountIncrements.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace csom {

/// Adds increments to chunks. One per thread: it keeps its memory from chunk to chunk.
class ChunkBuilder {
 public:
  /// Adds to `chunk`, which may be null: in place if nobody shares it and every (voxel, class) is
  /// there already, else to a copy.
  void add(ChunkRef& chunk, const std::vector<CountIncrement>& increments);
  /// The same with voxels that are free: where there is nothing else, without looking for places.
  void add(ChunkRef& chunk, const ChunkIncrements& increments);
  /// `base` plus `increments`; `base` may be null.
  ChunkRef sum(const Chunk* base, const std::vector<CountIncrement>& increments);
  /// Adds in place, or returns false if it cannot be done; see add().
  bool addInPlace(ChunkRef& chunk, const std::vector<CountIncrement>& increments);

  /// A chunk whose record is uninitialised.
  static ChunkRef allocate(std::size_t record_size);
  static void* record(const ChunkRef& chunk) { return chunk.chunk_ + 1; }

 private:
  /// Makes the members below those of the sum.
  void merge(const Chunk* base, const std::vector<CountIncrement>& increments);
  static ChunkRef build(const FreeIncrements& free);
  static bool addInPlace(ChunkRef& chunk, const FreeIncrements& free);
  bool fits(const ChunkRef& chunk) const;
  void overwriteCounts(ChunkRef& chunk) const;
  ChunkRef build() const;

  Chunk::Header header_{};
  // Their sizes are what was needed at most; the header says how much is in use.
  std::vector<std::uint32_t> counts_;
  std::vector<std::uint8_t> classes_;
  std::array<std::uint16_t, 512> first_entries_{};
  std::vector<CountIncrement> all_;  ///< increments with those of free voxels among them
};

}  // namespace csom
