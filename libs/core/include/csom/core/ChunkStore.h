// SPDX-License-Identifier: BSD-3-Clause
// The storage of a map: chunks found by their index, shared between copies until written.
#pragma once

#include <csom/core/Chunk.h>
#include <csom/core/CountIncrements.h>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace csom {

/// An open-addressing table from chunk index to chunk. Copying a store copies the table and shares
/// every chunk. Thread-safety as SemanticMap's.
class ChunkStore {
 public:
  const Chunk* find(const ChunkIndex& index) const {
    if (count_ == 0) return nullptr;
    const Slot& slot = slots_[slotOf(keyOf(index))];
    return slot.chunk.get();
  }

  /// Adds increments. `threads` as in Options; the result does not depend on it.
  void add(const ScanIncrements& increments, int threads);
  /// Adds the counts of a chunk; shares it if there was none at `index`.
  void add(const ChunkIndex& index, const ChunkRef& chunk);
  /// Adds every chunk of another store.
  void add(const ChunkStore& other);

  std::size_t chunkCount() const { return count_; }
  std::size_t memoryBytes() const;
  void clear();

  /// All chunks in z-major order of their indices.
  std::vector<std::pair<ChunkIndex, const Chunk*>> sorted() const;
  /// Those of an inclusive box of chunks, in the same order.
  std::vector<std::pair<ChunkIndex, const Chunk*>> sorted(const ChunkIndex& min,
                                                          const ChunkIndex& max) const;

  /// Calls visit(ChunkIndex, const Chunk&) for every chunk, in no particular order.
  template <class Visitor>
  void forEach(Visitor&& visit) const {
    for (const Slot& slot : slots_) {
      if (slot.chunk) visit(indexOf(slot.key), *slot.chunk);
    }
  }

 private:
  struct Slot {
    std::uint64_t key = 0;
    ChunkRef chunk;
  };

  /// 21 bits an axis; order of keys = z-major order of indices.
  static std::uint64_t keyOf(const ChunkIndex& index);
  static ChunkIndex indexOf(std::uint64_t key);

  std::size_t slotOf(std::uint64_t key) const;
  /// Returns the slot of `index`, with a null chunk if it is new. Invalidates references to slots.
  Slot& slotFor(const ChunkIndex& index);
  void reserve(std::size_t chunks);

  std::vector<Slot> slots_;  ///< a power of two, at most 3/4 full
  std::size_t count_ = 0;
};

}  // namespace csom
