// SPDX-License-Identifier: BSD-3-Clause
// What the surfaces of one scan say about each voxel.
#pragma once

#include <csom/core/CountIncrements.h>
#include <csom/core/Grid.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "inference/BoundedWords.h"
#include "util/ChunkKey.h"

namespace csom::detail {

/// What several collections say about one voxel.
class VoxelWord {
 public:
  void clear() {
    facet_ = 0;
    hits_.clear();
  }
  bool empty() const { return facet_ == 0 && hits_.empty(); }
  /// Appends it, by class. Not if it is empty.
  void appendTo(std::uint16_t voxel, std::vector<CountIncrement>& out);

 private:
  friend class VoxelWords;
  struct Hits {
    ClassId class_id;
    std::uint64_t shares;
  };
  void add(ClassId class_id, std::uint64_t shares);

  std::uint32_t facet_ = 0;  ///< as in VoxelWords::Cell
  std::vector<Hits> hits_;
};

/// Collects hits and facets, in any order. A voxel with hits has their classes, whatever facets
/// pass through it; one without hits has the class of the facet with the most weight (ties: the
/// lower class), and that weight.
class VoxelWords {
 public:
  /// Cells of a chunk: 0, the weight and class of a facet, or where the hits are counted.
  using Cell = std::uint32_t;
  struct Cells {
    std::uint64_t key;  ///< chunkKey() of the chunk, counted from the base
    std::array<Cell, kVoxelsPerChunk> cell;
  };

  /// A hit in voxel (x, y, z), counted from the base: `share` of it is of a class.
  void addHit(std::int32_t x, std::int32_t y, std::int32_t z, ClassId class_id,
              std::uint32_t share) {
    countHit(cellAt(x, y, z), class_id, share);
  }
  /// `weight` is that of a facet there [quanta], at most kFullWord.
  void addFacet(std::int32_t x, std::int32_t y, std::int32_t z, ClassId class_id,
                std::uint32_t weight) {
    raise(cellAt(x, y, z), (weight << 8U) | (0xffU - class_id));
  }

  void clear();

  /// In the order in which they came.
  std::size_t chunkCount() const { return chunks_.size(); }
  const Cells& chunk(std::size_t i) const { return *chunks_[i]; }
  /// Adds what a cell says to a word.
  void addTo(Cell cell, VoxelWord& word) const;

 private:
  static constexpr Cell kHits = 0x80000000U;
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  /// Hits of one class in a voxel; a list of these is a voxel's.
  struct Tally {
    std::uint64_t shares;
    std::uint32_t next;
    ClassId class_id;
  };

  Cell& cellAt(std::int32_t x, std::int32_t y, std::int32_t z) {
    const std::uint64_t key = chunkKey({chunkOf(x), chunkOf(y), chunkOf(z)});
    if (key != last_key_) {
      const Slot& recent = recent_[recentSlot(key)];
      if (recent.cells != nullptr && recent.key == key) {
        last_key_ = key;
        last_ = recent.cells;
      } else {
        select(key);
      }
    }
    return last_->cell[static_cast<std::size_t>(indexInChunk(VoxelIndex{x, y, z}))];
  }
  static void raise(Cell& cell, Cell facet) {
    if (cell < facet) cell = facet;  // hits are more than any facet
  }
  void countHit(Cell& cell, ClassId class_id, std::uint64_t shares);
  struct Slot {
    std::uint64_t key;
    Cells* cells;  ///< null: free
  };
  /// Facets of a row pass through the same few chunks.
  static constexpr std::size_t kRecent = 64;
  static std::size_t recentSlot(std::uint64_t key) {
    return (key + 5 * (key >> kChunkKeyAxisBits) + 11 * (key >> (2 * kChunkKeyAxisBits))) % kRecent;
  }
  void select(std::uint64_t key);
  Slot& slotOf(std::uint64_t key);
  Cells* newCells(std::uint64_t key);

  std::vector<Cells*> chunks_;
  std::vector<std::unique_ptr<Cells[]>> blocks_;  ///< that they lie in, kept when cleared
  std::vector<Slot> slots_;                       ///< by the hash of the key
  std::array<Slot, kRecent> recent_{};
  std::vector<Tally> tallies_;
  std::uint64_t last_key_ = ~std::uint64_t{0};
  Cells* last_ = nullptr;
};

}  // namespace csom::detail
