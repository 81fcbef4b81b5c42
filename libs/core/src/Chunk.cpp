// SPDX-License-Identifier: BSD-3-Clause
// Building, checking and reading chunk records.
#include <csom/core/Chunk.h>
#include <csom/core/DirichletVoxel.h>

#include <cstring>
#include <new>
#include <stdexcept>
#include <string>

namespace csom {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "chunk records are little-endian");

namespace {

std::size_t recordBytes(std::size_t voxels, std::size_t entries) {
  const std::size_t used = sizeof(Chunk::Header) + 4 * entries + 2 * voxels + entries;
  return (used + 7) / 8 * 8;
}

[[noreturn]] void rejectRecord(const std::string& reason) {
  throw std::runtime_error("not a valid chunk record: " + reason);
}

}  // namespace

/// The only code that writes into a chunk.
class ChunkBuilder {
 public:
  static Chunk* allocate(std::size_t record_size) {
    void* memory = ::operator new(sizeof(Chunk) + record_size);
    return new (memory) Chunk(static_cast<std::uint32_t>(record_size));
  }
  static void* record(Chunk* chunk) { return chunk + 1; }
  static std::uint32_t* counts(Chunk* chunk) { return const_cast<std::uint32_t*>(chunk->counts()); }
  static std::uint16_t* firstEntries(Chunk* chunk) {
    return const_cast<std::uint16_t*>(chunk->firstEntries());
  }
  static std::uint8_t* classes(Chunk* chunk) { return const_cast<std::uint8_t*>(chunk->classes()); }

  /// `entries` sorted by (voxel, class), each pair once, not empty.
  static ChunkRef build(const std::vector<CountIncrement>& entries) {
    Chunk::Header header{};
    for (const CountIncrement& entry : entries)
      header.known[entry.voxel >> 6U] |= std::uint64_t{1} << (entry.voxel & 63U);
    std::uint32_t voxels = 0;
    for (std::size_t word = 0; word < 8; ++word) {
      header.word_voxels[word] = static_cast<std::uint16_t>(voxels);
      voxels += static_cast<std::uint32_t>(__builtin_popcountll(header.known[word]));
    }
    header.voxel_count = voxels;
    header.entry_count = static_cast<std::uint32_t>(entries.size());

    const std::size_t size = recordBytes(voxels, entries.size());
    Chunk* chunk = allocate(size);
    auto* bytes = static_cast<unsigned char*>(record(chunk));
    std::memset(bytes + size - 8, 0, 8);  // the padding, before anything that may overlap it
    std::memcpy(bytes, &header, sizeof header);

    auto& word_entries = static_cast<Chunk::Header*>(record(chunk))->word_entries;
    std::uint32_t* const count = counts(chunk);
    std::uint16_t* const first = firstEntries(chunk);
    std::uint8_t* const class_id = classes(chunk);
    std::size_t voxel = 0;
    std::size_t word = 0;
    for (std::uint32_t i = 0; i < entries.size(); ++i) {
      const CountIncrement& entry = entries[i];
      count[i] = entry.count;
      class_id[i] = static_cast<std::uint8_t>(entry.class_id);
      if (i > 0 && entries[i - 1].voxel == entry.voxel) continue;
      for (const std::size_t current = entry.voxel >> 6U; word < current;) word_entries[++word] = i;
      first[voxel++] = static_cast<std::uint16_t>(i - word_entries[word]);
    }
    while (word < 7) word_entries[++word] = header.entry_count;
    return ChunkRef(chunk);
  }
};

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
  ChunkRef copy(ChunkBuilder::allocate(size));
  std::memcpy(ChunkBuilder::record(copy.chunk_), bytes, size);
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
  forEachKnown([&](int voxel) {
    const Entries entries = at(voxel);
    for (int i = 0; i < entries.size; ++i)
      out.push_back({static_cast<std::uint16_t>(voxel), entries.classes[i], entries.counts[i]});
  });
  return out;
}

ChunkRef Chunk::sum(const Chunk* base, const std::vector<CountIncrement>& increments) {
  if (base == nullptr) return ChunkBuilder::build(increments);
  const auto position = [](std::uint32_t voxel, std::uint32_t class_id) {
    return voxel << 16U | class_id;
  };
  std::vector<CountIncrement> merged;
  merged.reserve(base->header().entry_count + increments.size());
  auto next = increments.begin();
  base->forEachKnown([&](int voxel) {
    const Entries entries = base->at(voxel);
    for (int i = 0; i < entries.size; ++i) {
      CountIncrement entry{static_cast<std::uint16_t>(voxel), entries.classes[i],
                           entries.counts[i]};
      const std::uint32_t here = position(entry.voxel, entry.class_id);
      while (next != increments.end() && position(next->voxel, next->class_id) < here)
        merged.push_back(*next++);
      if (next != increments.end() && position(next->voxel, next->class_id) == here)
        entry.count = addCounts(entry.count, next++->count);
      merged.push_back(entry);
    }
  });
  merged.insert(merged.end(), next, increments.end());
  return ChunkBuilder::build(merged);
}

void ChunkRef::release() {
  if (chunk_ != nullptr && chunk_->references_.fetch_sub(1, std::memory_order_acq_rel) == 1) {
    chunk_->~Chunk();
    ::operator delete(chunk_);
  }
  chunk_ = nullptr;
}

bool ChunkRef::addInPlace(const std::vector<CountIncrement>& increments) {
  if (chunk_->references_.load(std::memory_order_acquire) != 1) return false;
  const auto position = [this](const CountIncrement& increment) -> std::uint32_t* {
    const Chunk::Entries entries = chunk_->at(increment.voxel);
    for (int i = 0; i < entries.size; ++i) {
      if (entries.classes[i] == increment.class_id)
        return const_cast<std::uint32_t*>(entries.counts + i);
    }
    return nullptr;
  };
  std::vector<std::uint32_t*> positions;
  positions.reserve(increments.size());
  for (const CountIncrement& increment : increments) {
    positions.push_back(position(increment));
    if (positions.back() == nullptr) return false;
  }
  for (std::size_t i = 0; i < increments.size(); ++i)
    *positions[i] = addCounts(*positions[i], increments[i].count);
  return true;
}

}  // namespace csom
