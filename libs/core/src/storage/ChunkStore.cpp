// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/ChunkStore.h>

#include <algorithm>

#include "storage/ChunkBuilder.h"
#include "util/ChunkKey.h"
#include "util/Parallel.h"

namespace csom {

namespace {
constexpr std::uint64_t kEmptyKey = ~std::uint64_t{0};
}  // namespace

std::uint64_t ChunkStore::keyOf(const ChunkIndex& index) {
  return detail::chunkKey(index);
}

ChunkIndex ChunkStore::indexOf(std::uint64_t key) {
  return detail::chunkOfKey(key);
}

std::size_t ChunkStore::slotOf(std::uint64_t key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = detail::mixedKey(key) & mask;
  while (slots_[slot].key != key && slots_[slot].key != kEmptyKey) slot = (slot + 1) & mask;
  return slot;
}

void ChunkStore::reserve(std::size_t chunks) {
  std::size_t capacity = slots_.empty() ? 16 : slots_.size();
  while (chunks * 4 > capacity * 3) capacity *= 2;
  if (capacity == slots_.size()) return;
  std::vector<Slot> old(capacity);
  for (Slot& slot : old) slot.key = kEmptyKey;
  old.swap(slots_);
  for (Slot& slot : old) {
    if (slot.key != kEmptyKey) slots_[slotOf(slot.key)] = std::move(slot);
  }
}

ChunkStore::Slot& ChunkStore::slotFor(const ChunkIndex& index) {
  reserve(count_ + 1);
  const std::uint64_t key = keyOf(index);
  Slot& slot = slots_[slotOf(key)];
  if (slot.key == kEmptyKey) {
    slot.key = key;
    ++count_;
  }
  return slot;
}

void ChunkStore::add(const ScanIncrements& increments, int threads) {
  reserve(count_ + increments.size());  // no slot moves below: each thread may write to its own
  std::vector<Slot*> slots;
  slots.reserve(increments.size());
  for (const ChunkIncrements& chunk : increments) slots.push_back(&slotFor(chunk.chunk));
  detail::parallelRanges(increments.size(), threads, [&](std::size_t begin, std::size_t end) {
    ChunkBuilder builder;
    for (std::size_t i = begin; i < end; ++i) builder.add(slots[i]->chunk, increments[i]);
  });
}

void ChunkStore::add(const ChunkIndex& index, const ChunkRef& chunk) {
  Slot& slot = slotFor(index);
  slot.chunk = slot.chunk ? Chunk::sum(slot.chunk.get(), chunk->toIncrements()) : chunk;
}

void ChunkStore::add(const ChunkStore& other) {
  if (&other == this) {
    const ChunkStore copy(other);  // slots must not move while they are read
    add(copy);
    return;
  }
  reserve(count_ + other.count_);
  for (const Slot& slot : other.slots_) {
    if (slot.chunk) add(indexOf(slot.key), slot.chunk);
  }
}

std::size_t ChunkStore::memoryBytes() const {
  std::size_t bytes = slots_.capacity() * sizeof(Slot);
  for (const Slot& slot : slots_) {
    if (slot.chunk) bytes += slot.chunk->memoryBytes();
  }
  return bytes;
}

void ChunkStore::clear() {
  slots_.clear();
  count_ = 0;
}

std::vector<std::pair<ChunkIndex, const Chunk*>> ChunkStore::sorted() const {
  std::vector<const Slot*> used;
  used.reserve(count_);
  for (const Slot& slot : slots_) {
    if (slot.chunk) used.push_back(&slot);
  }
  std::sort(used.begin(), used.end(), [](const Slot* a, const Slot* b) { return a->key < b->key; });
  std::vector<std::pair<ChunkIndex, const Chunk*>> out;
  out.reserve(used.size());
  for (const Slot* slot : used) out.emplace_back(indexOf(slot->key), slot->chunk.get());
  return out;
}

std::vector<std::pair<ChunkIndex, const Chunk*>> ChunkStore::sorted(const ChunkIndex& min,
                                                                    const ChunkIndex& max) const {
  std::vector<std::pair<ChunkIndex, const Chunk*>> out;
  const auto edge = [](std::int32_t lo, std::int32_t hi) {
    return std::max(0.0, static_cast<double>(hi) - lo + 1);
  };
  const double in_box = edge(min.x, max.x) * edge(min.y, max.y) * edge(min.z, max.z);
  if (in_box < static_cast<double>(count_)) {  // a small box: ask for each of its chunks
    for (std::int32_t z = min.z; z <= max.z; ++z)
      for (std::int32_t y = min.y; y <= max.y; ++y)
        for (std::int32_t x = min.x; x <= max.x; ++x) {
          const ChunkIndex index{x, y, z};
          const Chunk* const chunk = isAddressable(index) ? find(index) : nullptr;
          if (chunk != nullptr) out.emplace_back(index, chunk);
        }
    return out;
  }
  const auto inside = [](std::int32_t i, std::int32_t lo, std::int32_t hi) {
    return lo <= i && i <= hi;
  };
  for (const auto& entry : sorted()) {
    const ChunkIndex& i = entry.first;
    if (inside(i.x, min.x, max.x) && inside(i.y, min.y, max.y) && inside(i.z, min.z, max.z))
      out.push_back(entry);
  }
  return out;
}

}  // namespace csom
