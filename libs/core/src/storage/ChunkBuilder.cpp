// SPDX-License-Identifier: BSD-3-Clause
#include "storage/ChunkBuilder.h"

#include <csom/core/DirichletVoxel.h>

#include <algorithm>
#include <cstring>
#include <new>

#include "util/Lanes.h"

namespace csom {

namespace {

/// Walks through the known voxels of a chunk in order, to their entries.
class VoxelCursor {
 public:
  explicit VoxelCursor(const Chunk::Header& header, const std::uint16_t* first_entries)
      : header_(header), first_entries_(first_entries) {}

  /// Goes to the first voxel of a word.
  void enter(std::size_t word) {
    rank_ = header_.word_voxels[word];
    last_ = word < 7 ? header_.word_voxels[word + 1] : header_.voxel_count;
    word_begin_ = header_.word_entries[word];
    word_end_ = word < 7 ? header_.word_entries[word + 1] : header_.entry_count;
    end_ = word_begin_;
  }
  /// Goes on to the entries begin … end−1 of the next voxel of the word.
  void next() {
    begin_ = end_;
    ++rank_;
    end_ = rank_ < last_ ? word_begin_ + first_entries_[rank_] : word_end_;
  }
  std::uint32_t begin() const { return begin_; }
  std::uint32_t end() const { return end_; }

 private:
  const Chunk::Header& header_;
  const std::uint16_t* first_entries_;
  std::uint32_t rank_ = 0;  ///< voxels passed
  std::uint32_t last_ = 0;  ///< rank of the first voxel of the next word
  std::uint32_t word_begin_ = 0;
  std::uint32_t word_end_ = 0;
  std::uint32_t begin_ = 0;
  std::uint32_t end_ = 0;
};

}  // namespace

void ChunkBuilder::merge(const Chunk* base, const std::vector<CountIncrement>& increments) {
  static const Chunk::Header kNothing{};
  header_ = Chunk::Header{};
  const Chunk::Header& old_header = base != nullptr ? base->header() : kNothing;
  const std::uint32_t* const old_counts = base != nullptr ? base->counts() : nullptr;
  const std::uint8_t* const old_classes = base != nullptr ? base->classes() : nullptr;
  VoxelCursor old(old_header, base != nullptr ? base->firstEntries() : nullptr);
  const std::size_t most = increments.size() + old_header.entry_count;
  if (counts_.size() < most) {
    counts_.resize(most);
    classes_.resize(most);
  }
  header_.known = old_header.known;
  for (const CountIncrement& entry : increments)
    header_.known[entry.voxel >> 6U] |= std::uint64_t{1} << (entry.voxel & 63U);

  // Bytes may be part of anything: what is written through `classes` must not make the compiler
  // read members again.
  std::uint32_t* const counts = counts_.data();
  std::uint8_t* const classes = classes_.data();
  std::uint16_t* const first_entries = first_entries_.data();
  std::uint32_t voxels = 0;
  std::uint32_t entries = 0;
  const auto append = [&](ClassId class_id, std::uint32_t count) {
    classes[entries] = static_cast<std::uint8_t>(class_id);
    counts[entries++] = count;
  };
  const CountIncrement* next = increments.data();
  const CountIncrement* const last = next + increments.size();
  for (std::size_t word = 0; word < 8; ++word) {
    const std::uint32_t word_entries = entries;
    header_.word_voxels[word] = static_cast<std::uint16_t>(voxels);
    header_.word_entries[word] = word_entries;
    const std::uint64_t old_known = old_header.known[word];
    if (old_known != 0) old.enter(word);
    for (std::uint64_t bits = header_.known[word]; bits != 0; bits &= bits - 1) {
      const std::uint64_t bit = bits & -bits;
      const std::size_t voxel = word * 64 + static_cast<std::size_t>(__builtin_ctzll(bits));
      first_entries[voxels++] = static_cast<std::uint16_t>(entries - word_entries);
      const CountIncrement* end = next;
      while (end != last && end->voxel == voxel) ++end;
      if ((old_known & bit) != 0) {
        old.next();
        for (std::uint32_t i = old.begin(); i < old.end(); ++i) {
          const std::uint8_t class_id = old_classes[i];
          for (; next != end && next->class_id < class_id; ++next)
            append(next->class_id, next->count);
          const bool both = next != end && next->class_id == class_id;
          append(class_id, both ? addCounts(old_counts[i], next->count) : old_counts[i]);
          next += both ? 1 : 0;
        }
      }
      for (; next != end; ++next) append(next->class_id, next->count);
    }
  }
  header_.voxel_count = voxels;
  header_.entry_count = entries;
}

ChunkRef ChunkBuilder::allocate(std::size_t record_size) {
  void* memory = ::operator new(sizeof(Chunk) + record_size);
  return ChunkRef(new (memory) Chunk(static_cast<std::uint32_t>(record_size)));
}

ChunkRef ChunkBuilder::build() const {
  const std::size_t size = Chunk::recordBytes(header_.voxel_count, header_.entry_count);
  ChunkRef chunk = allocate(size);
  auto* bytes = static_cast<unsigned char*>(record(chunk));
  std::memset(bytes + size - 8, 0, 8);  // the padding, before anything that may overlap it
  const auto put = [&bytes](const void* data, std::size_t length) {
    std::memcpy(bytes, data, length);
    bytes += length;
  };
  put(&header_, sizeof header_);
  put(counts_.data(), header_.entry_count * sizeof counts_[0]);
  put(first_entries_.data(), header_.voxel_count * sizeof first_entries_[0]);
  put(classes_.data(), header_.entry_count * sizeof classes_[0]);
  return chunk;
}

ChunkRef ChunkBuilder::sum(const Chunk* base, const std::vector<CountIncrement>& increments) {
  merge(base, increments);
  return build();
}

/// Whether nothing but counts differs between the sum and `chunk`, its base, and they may change.
bool ChunkBuilder::fits(const ChunkRef& chunk) const {
  return chunk.chunk_->references_.load(std::memory_order_acquire) == 1 &&
         chunk->header().entry_count == header_.entry_count;
}

void ChunkBuilder::overwriteCounts(ChunkRef& chunk) const {
  std::memcpy(static_cast<Chunk::Header*>(record(chunk)) + 1, counts_.data(),
              header_.entry_count * sizeof counts_[0]);
}

void ChunkBuilder::add(ChunkRef& chunk, const std::vector<CountIncrement>& increments) {
  merge(chunk.get(), increments);
  if (chunk && fits(chunk)) {
    overwriteCounts(chunk);
  } else {
    chunk = build();
  }
}

void ChunkBuilder::add(ChunkRef& chunk, const ChunkIncrements& increments) {
  const FreeIncrements& free = increments.free;
  if (free.empty()) {
    add(chunk, increments.increments);
    return;
  }
  if (increments.increments.empty()) {
    if (!chunk) {
      chunk = build(free);
      return;
    }
    if (addInPlace(chunk, free)) return;
  }
  all_.clear();
  auto next = increments.increments.begin();
  const auto end = increments.increments.end();
  for (std::size_t word = 0; word < free.voxels.size(); ++word)
    for (std::uint64_t bits = free.voxels[word]; bits != 0; bits &= bits - 1) {
      const auto voxel =
          static_cast<std::uint16_t>(word * 64 + static_cast<std::size_t>(__builtin_ctzll(bits)));
      while (next != end && next->voxel < voxel) all_.push_back(*next++);
      all_.push_back({voxel, kFreeClass, free.count});
    }
  all_.insert(all_.end(), next, end);
  add(chunk, all_);
}

/// A chunk of nothing but free voxels.
ChunkRef ChunkBuilder::build(const FreeIncrements& free) {
  Chunk::Header header{};
  header.known = free.voxels;
  std::uint32_t voxels = 0;
  for (std::size_t word = 0; word < header.known.size(); ++word) {
    header.word_entries[word] = voxels;
    header.word_voxels[word] = static_cast<std::uint16_t>(voxels);
    voxels += static_cast<std::uint32_t>(__builtin_popcountll(header.known[word]));
  }
  header.voxel_count = voxels;
  header.entry_count = voxels;
  const std::size_t size = Chunk::recordBytes(voxels, voxels);
  ChunkRef chunk = allocate(size);
  auto* const bytes = static_cast<unsigned char*>(record(chunk));
  std::memcpy(bytes, &header, sizeof header);
  auto* const counts = reinterpret_cast<std::uint32_t*>(bytes + sizeof header);
  std::fill_n(counts, voxels, free.count);
  auto* first_entry = reinterpret_cast<std::uint16_t*>(counts + voxels);
  for (const std::uint64_t known : header.known)
    for (int i = 0; i < __builtin_popcountll(known); ++i)
      *first_entry++ = static_cast<std::uint16_t>(i);
  auto* const classes = reinterpret_cast<unsigned char*>(first_entry);
  std::memset(classes, kFreeClass, static_cast<std::size_t>(bytes + size - classes));
  return chunk;
}

/// If nobody shares the chunk and all these voxels have been free before.
bool ChunkBuilder::addInPlace(ChunkRef& chunk, const FreeIncrements& free) {
  if (chunk.chunk_->references_.load(std::memory_order_acquire) != 1) return false;
  const Chunk::Header& header = chunk->header();
  const std::uint8_t* const classes = chunk->classes();
  const std::uint16_t* const first_entries = chunk->firstEntries();
  const auto forEachEntry = [&](const auto& visit) {
    for (std::size_t word = 0; word < free.voxels.size(); ++word) {
      const std::uint64_t known = header.known[word];
      if ((free.voxels[word] & ~known) != 0) return false;
      const std::uint16_t* const entries = first_entries + header.word_voxels[word];
      for (std::uint64_t bits = free.voxels[word]; bits != 0; bits &= bits - 1) {
        const std::uint64_t before = (bits & -bits) - 1;
        const int rank = __builtin_popcountll(known & before);
        if (!visit(header.word_entries[word] + entries[rank])) return false;
      }
    }
    return true;
  };
  if (!forEachEntry([&](std::uint32_t entry) { return classes[entry] == kFreeClass; }))
    return false;
  auto* const counts =
      reinterpret_cast<std::uint32_t*>(static_cast<Chunk::Header*>(record(chunk)) + 1);
  return forEachEntry([&](std::uint32_t entry) {
    counts[entry] = addCounts(counts[entry], free.count);
    return true;
  });
}

bool ChunkBuilder::addInPlace(ChunkRef& chunk, const std::vector<CountIncrement>& increments) {
  merge(chunk.get(), increments);
  if (!fits(chunk)) return false;
  overwriteCounts(chunk);
  return true;
}

}  // namespace csom
