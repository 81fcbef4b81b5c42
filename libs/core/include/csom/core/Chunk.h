// SPDX-License-Identifier: BSD-3-Clause
// 8×8×8 voxels in one contiguous, immutable, reference-counted record.
#pragma once

#include <csom/core/CountIncrements.h>
#include <csom/core/Grid.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace csom {

class ChunkRef;

/// A chunk is a record that is stored in files and streams exactly as it lies in memory
/// (little-endian; docs/file-format.md shows it byte by byte):
///
///     u64 known[8]            bit v of the 512: voxel v has counts
///     u32 word_entries[8]     number of entries before the voxels of word w
///     u16 word_voxels[8]      number of known voxels before word w
///     u32 voxel_count, u32 entry_count
///     u32 counts[entry_count]          sorted by voxel, then class; never 0
///     u16 first_entry[voxel_count]     of each known voxel, relative to its word's word_entries
///     u8  classes[entry_count]
///     0-bytes up to a multiple of 8
///
/// The record is canonical: equal contents are equal bytes. A voxel costs 2 bytes and 5 more for
/// each class that it has seen, a chunk 120 bytes.
class Chunk {
 public:
  struct Header {
    std::array<std::uint64_t, 8> known;
    std::array<std::uint32_t, 8> word_entries;
    std::array<std::uint16_t, 8> word_voxels;
    std::uint32_t voxel_count;
    std::uint32_t entry_count;
  };
  static_assert(sizeof(Header) == 120, "the header is part of the file format");

  /// The classes and counts of one voxel.
  struct Entries {
    const std::uint8_t* classes = nullptr;
    const std::uint32_t* counts = nullptr;
    int size = 0;
  };

  Chunk(const Chunk&) = delete;
  Chunk& operator=(const Chunk&) = delete;

  /// Checks every byte; throws std::runtime_error that says what is wrong.
  static ChunkRef fromRecord(const void* bytes, std::size_t size, int number_of_classes);
  /// `base` plus `increments`; `base` may be null.
  static ChunkRef sum(const Chunk* base, const std::vector<CountIncrement>& increments);

  const void* record() const { return this + 1; }
  std::size_t recordSize() const { return record_size_; }
  std::size_t memoryBytes() const { return sizeof(Chunk) + record_size_; }

  int knownVoxels() const { return static_cast<int>(header().voxel_count); }
  Entries at(int index_in_chunk) const;

  /// Calls visit(index_in_chunk) for every known voxel in ascending order.
  template <class Visitor>
  void forEachKnown(Visitor&& visit) const {
    for (int word = 0; word < 8; ++word) {
      for (std::uint64_t bits = header().known[static_cast<std::size_t>(word)]; bits != 0;
           bits &= bits - 1)
        visit(word * 64 + __builtin_ctzll(bits));
    }
  }

  /// Calls visit(index_in_chunk, Entries) for every known voxel in ascending order.
  template <class Visitor>
  void forEachVoxel(Visitor&& visit) const;

  /// All entries as increments.
  std::vector<CountIncrement> toIncrements() const;

 private:
  friend class ChunkRef;
  friend class ChunkBuilder;
  explicit Chunk(std::uint32_t record_size) : record_size_(record_size) {}

  static std::size_t recordBytes(std::size_t voxels, std::size_t entries);
  const Header& header() const { return *static_cast<const Header*>(record()); }
  const std::uint32_t* counts() const {
    return reinterpret_cast<const std::uint32_t*>(&header() + 1);
  }
  const std::uint16_t* firstEntries() const {
    return reinterpret_cast<const std::uint16_t*>(counts() + header().entry_count);
  }
  const std::uint8_t* classes() const {
    return reinterpret_cast<const std::uint8_t*>(firstEntries() + header().voxel_count);
  }

  mutable std::atomic<std::uint32_t> references_{0};
  std::uint32_t record_size_;
};

template <class Visitor>
void Chunk::forEachVoxel(Visitor&& visit) const {
  const Header& h = header();
  const std::uint32_t* const all_counts = counts();
  const std::uint8_t* const all_classes = classes();
  const std::uint16_t* next_voxel = firstEntries();
  for (std::size_t word = 0; word < h.known.size(); ++word) {
    const bool is_last = word + 1 == h.known.size();
    const std::uint32_t word_end = is_last ? h.entry_count : h.word_entries[word + 1];
    std::uint32_t begin = h.word_entries[word];
    for (std::uint64_t bits = h.known[word]; bits != 0;) {
      const int voxel = static_cast<int>(word) * 64 + __builtin_ctzll(bits);
      bits &= bits - 1;
      ++next_voxel;
      const std::uint32_t end = bits != 0 ? h.word_entries[word] + *next_voxel : word_end;
      visit(voxel, Entries{all_classes + begin, all_counts + begin, static_cast<int>(end - begin)});
      begin = end;
    }
  }
}

/// Shared ownership of a chunk. Copying costs one atomic increment.
class ChunkRef {
 public:
  ChunkRef() = default;
  explicit ChunkRef(Chunk* chunk) : chunk_(chunk) { acquire(); }
  ChunkRef(const ChunkRef& other) : chunk_(other.chunk_) { acquire(); }
  ChunkRef(ChunkRef&& other) noexcept : chunk_(std::exchange(other.chunk_, nullptr)) {}
  ChunkRef& operator=(ChunkRef other) noexcept {
    std::swap(chunk_, other.chunk_);
    return *this;
  }
  ~ChunkRef() { release(); }

  const Chunk* get() const { return chunk_; }
  const Chunk* operator->() const { return chunk_; }
  const Chunk& operator*() const { return *chunk_; }
  explicit operator bool() const { return chunk_ != nullptr; }

  /// Adds in place if this is the only reference and every (voxel, class) is there already.
  bool addInPlace(const std::vector<CountIncrement>& increments);

 private:
  friend class Chunk;
  friend class ChunkBuilder;
  void acquire() const {
    if (chunk_ != nullptr) chunk_->references_.fetch_add(1, std::memory_order_relaxed);
  }
  void release();

  Chunk* chunk_ = nullptr;
};

}  // namespace csom
