// SPDX-License-Identifier: BSD-3-Clause
// Integer positions packed into one integer each and sorted: the library's way of grouping points,
// in place of a hash map. Stable, so that the order inside a group is that of the input.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "util/Parallel.h"
#include "util/Parts.h"

namespace csom::detail {

/// `Key` is std::uint32_t wherever keys are short enough: half the memory to move.
template <class Key>
struct KeyedItem {
  Key key;
  std::uint32_t item;
};

inline int bitsFor(std::uint64_t max_value) {
  return max_value == 0 ? 0 : 64 - __builtin_clzll(max_value);
}

/// One pass of a radix sort: `from` to `to`, ordered by one digit of the keys. Each part of the
/// items counts its digits; where a part's items of one digit go follows from the counts of all.
template <class Key>
void sortByDigit(const std::vector<KeyedItem<Key>>& from, std::vector<KeyedItem<Key>>& to,
                 int shift, int digit_bits, std::size_t parts, int threads) {
  const std::size_t buckets = std::size_t{1} << digit_bits;
  const auto digit = [=](const KeyedItem<Key>& i) { return (i.key >> shift) & (buckets - 1); };
  std::vector<std::uint32_t> positions(parts * buckets);
  const auto forEachPart = [&](const auto& work) {
    parallelRanges(parts, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t part = begin; part < end; ++part)
        work(positions.data() + part * buckets, from.data() + partBegin(from.size(), part, parts),
             from.data() + partBegin(from.size(), part + 1, parts));
    });
  };
  forEachPart([&](std::uint32_t* count, const KeyedItem<Key>* item, const KeyedItem<Key>* end) {
    for (; item != end; ++item) ++count[digit(*item)];
  });
  std::uint32_t sum = 0;
  for (std::size_t bucket = 0; bucket < buckets; ++bucket)
    for (std::size_t part = 0; part < parts; ++part)
      sum += std::exchange(positions[part * buckets + bucket], sum);
  forEachPart([&](std::uint32_t* position, const KeyedItem<Key>* item, const KeyedItem<Key>* end) {
    for (; item != end; ++item) to[position[digit(*item)]++] = *item;
  });
}

/// Sorts by key; items with equal keys stay in order. Keys have at most `bits` significant bits.
template <class Key>
void stableSort(std::vector<KeyedItem<Key>>& items, int bits, int threads = 1) {
  constexpr int kMaxDigitBits = 11;
  if (items.size() < 512) {
    std::stable_sort(
        items.begin(), items.end(),
        [](const KeyedItem<Key>& a, const KeyedItem<Key>& b) { return a.key < b.key; });
    return;
  }
  const std::size_t parts = partsFor(items.size(), threads);
  const int passes = (bits + kMaxDigitBits - 1) / kMaxDigitBits;
  std::vector<KeyedItem<Key>> other(items.size());
  for (int pass = 0, shift = 0; pass < passes; ++pass) {
    const int digit_bits = (bits - shift + passes - pass - 1) / (passes - pass);
    sortByDigit(items, other, shift, digit_bits, parts, threads);
    items.swap(other);
    shift += digit_bits;
  }
}

/// Packs positions of a known box into z-major keys with as few bits as the box needs.
class KeyPacking {
 public:
  using Position = std::array<std::int64_t, 3>;  ///< x, y, z

  /// The smallest box with all positions that include() was given.
  void include(const Position& p) {
    for (std::size_t a = 0; a < 3; ++a) {
      min_[a] = std::min(min_[a], p[a]);
      max_[a] = std::max(max_[a], p[a]);
    }
  }
  /// Widens the box by `margin` on every side and fixes the number of bits; before pack().
  void finish(std::int64_t margin = 0) {
    if (min_[0] > max_[0]) min_ = max_ = {0, 0, 0};  // there was none
    for (std::size_t a = 0; a < 3; ++a) {
      min_[a] -= margin;
      max_[a] += margin;
      bits_[a] = bitsFor(static_cast<std::uint64_t>(max_[a] - min_[a]));
    }
    assert(bits() <= 64);
  }
  int bits() const { return bits_[0] + bits_[1] + bits_[2]; }
  bool isShort() const { return bits() <= 32; }

  template <class Key = std::uint64_t>
  Key pack(const Position& p) const {
    const auto offset = [&](std::size_t a) { return static_cast<Key>(p[a] - min_[a]); };
    // An axis whose bits fill the whole key leaves none to be shifted by.
    const auto shifted = [](Key key, int bits) {
      return bits < std::numeric_limits<Key>::digits ? static_cast<Key>(key << bits) : Key{0};
    };
    return shifted(shifted(offset(2), bits_[1]) | offset(1), bits_[0]) | offset(0);
  }
  Position unpack(std::uint64_t key) const {
    const auto axis = [](std::uint64_t k, int bits) {
      return static_cast<std::int64_t>(k & ((std::uint64_t{1} << bits) - 1));
    };
    return {axis(key, bits_[0]) + min_[0], axis(key >> bits_[0], bits_[1]) + min_[1],
            axis(key >> (bits_[0] + bits_[1]), bits_[2]) + min_[2]};
  }

 private:
  Position min_{std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::max(),
                std::numeric_limits<std::int64_t>::max()};
  Position max_{std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::min(),
                std::numeric_limits<std::int64_t>::min()};
  std::array<int, 3> bits_{};
};

/// Calls work(Key{}) with the type of key that a packing's keys fit into.
template <class Work>
auto withKeyOf(const KeyPacking& packing, const Work& work) {
  return packing.isShort() ? work(std::uint32_t{}) : work(std::uint64_t{});
}

/// Items 0 … size−1 in z-major order of positionOf(item).
template <class PositionOf>
std::vector<KeyedItem<std::uint64_t>> sortedByPosition(std::size_t size, PositionOf&& positionOf) {
  KeyPacking packing;
  for (std::size_t i = 0; i < size; ++i) packing.include(positionOf(i));
  packing.finish();
  std::vector<KeyedItem<std::uint64_t>> items(size);
  for (std::size_t i = 0; i < size; ++i)
    items[i] = {packing.pack(positionOf(i)), static_cast<std::uint32_t>(i)};
  stableSort(items, packing.bits());
  return items;
}

/// Calls visit(begin, end) for each run of equal keys that begins in [first, last).
template <class Key, class Visitor>
void forEachRun(const std::vector<KeyedItem<Key>>& items, std::size_t first, std::size_t last,
                Visitor&& visit) {
  std::size_t begin = first;
  if (begin > 0) {
    while (begin < last && items[begin].key == items[begin - 1].key) ++begin;
  }
  while (begin < last) {
    std::size_t end = begin + 1;
    while (end < items.size() && items[end].key == items[begin].key) ++end;
    visit(begin, end);
    begin = end;
  }
}
template <class Key, class Visitor>
void forEachRun(const std::vector<KeyedItem<Key>>& items, Visitor&& visit) {
  forEachRun(items, 0, items.size(), visit);
}

}  // namespace csom::detail
