// SPDX-License-Identifier: BSD-3-Clause
// Checking and reading chunk records.
#include <csom/core/Chunk.h>

#include <cstring>
#include <stdexcept>
#include <string>

#include "storage/ChunkBuilder.h"

namespace csom {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "chunk records are little-endian");

namespace {

[[noreturn]] void rejectRecord(const std::string& reason) {
  throw std::runtime_error("not a valid chunk record: " + reason);
}

}  // namespace

std::size_t Chunk::recordBytes(std::size_t voxels, std::size_t entries) {
  const std::size_t used = sizeof(Header) + 4 * entries + 2 * voxels + entries;
  return (used + 7) / 8 * 8;
}

ChunkRef Chunk::fromRecord(const void* bytes, std::size_t size, int number_of_classes) {
  if (size < sizeof(Header)) rejectRecord(std::to_string(size) + " bytes, shorter than its header");
  Header header;
  std::memcpy(&header, bytes, sizeof header);
  std::uint32_t voxels = 0;
  for (std::size_t word = 0; word < 8; ++word) {
    if (header.word_voxels[word] != voxels) rejectRecord("voxel numbers do not match its bit mask");
    voxels += static_cast<std::uint32_t>(__builtin_popcountll(header.known[word]));
  }
  if (voxels == 0 || header.voxel_count != voxels)
    rejectRecord("voxel count does not match its bit mask");
  if (header.entry_count < voxels ||
      header.entry_count > voxels * static_cast<std::uint32_t>(number_of_classes))
    rejectRecord("impossible number of entries " + std::to_string(header.entry_count));
  if (size != recordBytes(voxels, header.entry_count))
    rejectRecord(std::to_string(size) + " bytes instead of " +
                 std::to_string(recordBytes(voxels, header.entry_count)));

  // The sizes fit: only now is memory taken and the rest looked at.
  ChunkRef copy = ChunkBuilder::allocate(size);
  std::memcpy(ChunkBuilder::record(copy), bytes, size);
  std::uint32_t rank = 0;
  for (std::size_t word = 0; word < 8; ++word) {
    const std::uint32_t begin = header.word_entries[word];
    const std::uint32_t end = word < 7 ? header.word_entries[word + 1] : header.entry_count;
    if (begin > end || end > header.entry_count || (word == 0 && begin != 0))
      rejectRecord("entry offsets run backwards");
    const int in_word = __builtin_popcountll(header.known[word]);
    if (in_word == 0 && begin != end) rejectRecord("entries without a voxel");
    for (int i = 0; i < in_word; ++i, ++rank) {
      const std::uint32_t first = begin + copy->firstEntries()[rank];
      const std::uint32_t last = i + 1 < in_word ? begin + copy->firstEntries()[rank + 1] : end;
      if ((i == 0 && first != begin) || first >= last || last > end)
        rejectRecord("entry offsets run backwards");
      for (std::uint32_t entry = first; entry < last; ++entry) {
        if (copy->classes()[entry] >= number_of_classes)
          rejectRecord("class " + std::to_string(copy->classes()[entry]) + " of " +
                       std::to_string(number_of_classes));
        if (entry > first && copy->classes()[entry] <= copy->classes()[entry - 1])
          rejectRecord("classes out of order");
        if (copy->counts()[entry] == 0) rejectRecord("a count of zero");
      }
    }
  }
  const auto* const end = static_cast<const unsigned char*>(copy->record()) + size;
  for (const unsigned char* pad = copy->classes() + header.entry_count; pad < end; ++pad) {
    if (*pad != 0) rejectRecord("padding is not zero");
  }
  return copy;
}

Chunk::Entries Chunk::at(int index_in_chunk) const {
  const auto word = static_cast<std::size_t>(index_in_chunk) >> 6U;
  const std::uint64_t bit = std::uint64_t{1} << (static_cast<unsigned>(index_in_chunk) & 63U);
  const Header& h = header();
  if ((h.known[word] & bit) == 0) return {};
  const auto rank = h.word_voxels[word] +
                    static_cast<std::uint32_t>(__builtin_popcountll(h.known[word] & (bit - 1)));
  const std::uint32_t next_word_voxels = word < 7 ? h.word_voxels[word + 1] : h.voxel_count;
  const std::uint32_t next_word_entries = word < 7 ? h.word_entries[word + 1] : h.entry_count;
  const std::uint32_t begin = h.word_entries[word] + firstEntries()[rank];
  const std::uint32_t end = rank + 1 < next_word_voxels
                                ? h.word_entries[word] + firstEntries()[rank + 1]
                                : next_word_entries;
  return {classes() + begin, counts() + begin, static_cast<int>(end - begin)};
}

std::vector<CountIncrement> Chunk::toIncrements() const {
  std::vector<CountIncrement> out;
  out.reserve(header().entry_count);
  forEachVoxel([&](int voxel, const Entries& entries) {
    for (int i = 0; i < entries.size; ++i)
      out.push_back({static_cast<std::uint16_t>(voxel), entries.classes[i], entries.counts[i]});
  });
  return out;
}

ChunkRef Chunk::sum(const Chunk* base, const std::vector<CountIncrement>& increments) {
  return ChunkBuilder().sum(base, increments);
}

void ChunkRef::release() {
  if (chunk_ != nullptr && chunk_->references_.fetch_sub(1, std::memory_order_acq_rel) == 1) {
    chunk_->~Chunk();
    ::operator delete(chunk_);
  }
  chunk_ = nullptr;
}

bool ChunkRef::addInPlace(const std::vector<CountIncrement>& increments) {
  return ChunkBuilder().addInPlace(*this, increments);
}

}  // namespace csom
