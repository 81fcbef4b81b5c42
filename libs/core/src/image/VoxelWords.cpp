// SPDX-License-Identifier: BSD-3-Clause
#include "image/VoxelWords.h"

#include <algorithm>

namespace csom::detail {

VoxelWords::Slot& VoxelWords::slotOf(std::uint64_t key) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = mixedKey(key) & mask;
  while (slots_[slot].cells != nullptr && slots_[slot].key != key) slot = (slot + 1) & mask;
  return slots_[slot];
}

VoxelWords::Cells* VoxelWords::newCells(std::uint64_t key) {
  constexpr std::size_t kBlock = 64;
  const std::size_t block = chunks_.size() / kBlock;
  if (block == blocks_.size()) blocks_.push_back(std::make_unique<Cells[]>(kBlock));  // zeros
  Cells* const cells = &blocks_[block][chunks_.size() % kBlock];
  cells->key = key;
  chunks_.push_back(cells);
  return cells;
}

void VoxelWords::clear() {
  for (Cells* cells : chunks_) cells->cell.fill(0);
  chunks_.clear();
  std::fill(slots_.begin(), slots_.end(), Slot{0, nullptr});
  recent_ = {};
  tallies_.clear();
  last_key_ = ~std::uint64_t{0};
  last_ = nullptr;
}

void VoxelWords::select(std::uint64_t key) {
  if (2 * (chunks_.size() + 1) > slots_.size()) {
    slots_.assign(std::max<std::size_t>(1024, 2 * slots_.size()), {0, nullptr});
    for (Cells* cells : chunks_) slotOf(cells->key) = {cells->key, cells};
  }
  Slot& slot = slotOf(key);
  if (slot.cells == nullptr) slot = {key, newCells(key)};
  recent_[recentSlot(key)] = slot;
  last_key_ = key;
  last_ = slot.cells;
}

void VoxelWords::countHit(Cell& cell, ClassId class_id, std::uint64_t shares) {
  std::uint32_t tally = (cell & kHits) != 0 ? cell & ~kHits : kNone;
  while (tally != kNone && tallies_[tally].class_id != class_id) tally = tallies_[tally].next;
  if (tally != kNone) {
    tallies_[tally].shares += shares;
    return;
  }
  const std::uint32_t first = (cell & kHits) != 0 ? cell & ~kHits : kNone;
  cell = kHits | static_cast<std::uint32_t>(tallies_.size());
  tallies_.push_back({shares, first, class_id});
}

void VoxelWords::addTo(Cell cell, VoxelWord& word) const {
  if ((cell & kHits) == 0) {
    raise(word.facet_, cell);
    return;
  }
  for (std::uint32_t tally = cell & ~kHits; tally != kNone; tally = tallies_[tally].next)
    word.add(tallies_[tally].class_id, tallies_[tally].shares);
}

void VoxelWord::add(ClassId class_id, std::uint64_t shares) {
  for (Hits& hits : hits_)
    if (hits.class_id == class_id) {
      hits.shares += shares;
      return;
    }
  hits_.push_back({class_id, shares});
}

void VoxelWord::appendTo(std::uint16_t voxel, std::vector<CountIncrement>& out) {
  if (hits_.empty()) {
    out.push_back({voxel, static_cast<ClassId>(0xffU - (facet_ & 0xffU)), facet_ >> 8U});
    return;
  }
  if (hits_.size() > 1)
    std::sort(hits_.begin(), hits_.end(),
              [](const Hits& a, const Hits& b) { return a.class_id < b.class_id; });
  std::uint64_t all = 0;
  for (const Hits& hits : hits_) all += hits.shares;
  for (const Hits& hits : hits_) {
    const std::uint64_t count = (2 * kFullWord * hits.shares + all) / (2 * all);
    if (count > 0) out.push_back({voxel, hits.class_id, static_cast<std::uint32_t>(count)});
  }
}

}  // namespace csom::detail
