// SPDX-License-Identifier: BSD-3-Clause
#include "ChunkBuilder.h"

#include <csom/core/DirichletVoxel.h>

#include <algorithm>
#include <cstring>
#include <new>

#include "Lanes.h"

namespace csom {

namespace {

/// Entries of the chunk's voxels, one voxel after the other.
struct VoxelCursor {
  const Chunk::Header* header;
  const std::uint16_t* first_entries;
  std::uint32_t rank = 0;   ///< voxels passed
  std::uint32_t begin = 0;  ///< first entry of the voxel at hand
  std::uint32_t end = 0;    ///< one beyond its last

  /// Goes on to the next known voxel, which lies in word `word`.
  void next(std::size_t word) {
    begin = end;
    ++rank;
    const std::uint32_t word_voxels =
        word < 7 ? header->word_voxels[word + 1] : header->voxel_count;
    if (rank < word_voxels) {
      end = header->word_entries[word] + first_entries[rank];
    } else {
      end = word < 7 ? header->word_entries[word + 1] : header->entry_count;
    }
  }
};

}  // namespace

void ChunkBuilder::merge(const Chunk* base, const std::vector<CountIncrement>& increments) {
  header_ = Chunk::Header{};
  std::size_t most = increments.size();
  VoxelCursor old{};
  const std::uint32_t* old_counts = nullptr;
  const std::uint8_t* old_classes = nullptr;
  std::array<std::uint64_t, 8> old_known{};
  if (base != nullptr) {
    old_known = base->header().known;
    most += base->header().entry_count;
    old = {&base->header(), base->firstEntries()};
    old_counts = base->counts();
    old_classes = base->classes();
  }
  if (counts_.size() < most) {
    counts_.resize(most);
    classes_.resize(most);
  }
  header_.known = old_known;
  for (const CountIncrement& entry : increments)
    header_.known[entry.voxel >> 6U] |= std::uint64_t{1} << (entry.voxel & 63U);

  std::uint32_t voxels = 0;
  std::uint32_t entries = 0;
  const auto append = [&](std::uint8_t class_id, std::uint32_t count) {
    classes_[entries] = class_id;
    counts_[entries++] = count;
  };
  const CountIncrement* next = increments.data();
  const CountIncrement* const last = next + increments.size();
  for (std::size_t word = 0; word < 8; ++word) {
    header_.word_voxels[word] = static_cast<std::uint16_t>(voxels);
    header_.word_entries[word] = entries;
    for (std::uint64_t bits = header_.known[word]; bits != 0; bits &= bits - 1) {
      const auto bit = static_cast<unsigned>(__builtin_ctzll(bits));
      const std::size_t voxel = word * 64 + bit;
      first_entries_[voxels++] = static_cast<std::uint16_t>(entries - header_.word_entries[word]);
      if ((old_known[word] >> bit & 1U) != 0) {
        old.next(word);
        for (std::uint32_t i = old.begin; i < old.end; ++i) {
          for (; next != last && next->voxel == voxel && next->class_id < old_classes[i]; ++next)
            append(static_cast<std::uint8_t>(next->class_id), next->count);
          const bool both =
              next != last && next->voxel == voxel && next->class_id == old_classes[i];
          append(old_classes[i], both ? addCounts(old_counts[i], next->count) : old_counts[i]);
          next += both ? 1 : 0;
        }
      }
      for (; next != last && next->voxel == voxel; ++next)
        append(static_cast<std::uint8_t>(next->class_id), next->count);
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

bool ChunkBuilder::addInPlace(ChunkRef& chunk, const std::vector<CountIncrement>& increments) {
  merge(chunk.get(), increments);
  if (!fits(chunk)) return false;
  overwriteCounts(chunk);
  return true;
}

}  // namespace csom
