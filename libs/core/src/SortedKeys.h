// SPDX-License-Identifier: BSD-3-Clause
// Integer positions packed into one integer each and sorted: the library's way of grouping points,
// in place of a hash map. Stable, so that the order inside a group is that of the input.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <limits>
#include <vector>

namespace csom::detail {

struct KeyedItem {
  std::uint64_t key;
  std::uint32_t item;
};

inline int bitsFor(std::uint64_t max_value) {
  return max_value == 0 ? 0 : 64 - __builtin_clzll(max_value);
}

/// Sorts by key; items with equal keys stay in order. Keys have at most `bits` significant bits.
inline void stableSort(std::vector<KeyedItem>& items, int bits) {
  constexpr int kDigitBits = 11;
  constexpr std::size_t kBuckets = std::size_t{1} << kDigitBits;
  if (items.size() < 512) {
    std::stable_sort(items.begin(), items.end(),
                     [](const KeyedItem& a, const KeyedItem& b) { return a.key < b.key; });
    return;
  }
  std::vector<KeyedItem> other(items.size());
  for (int shift = 0; shift < bits; shift += kDigitBits) {
    std::array<std::uint32_t, kBuckets> begin{};
    const auto digit = [shift](const KeyedItem& i) { return (i.key >> shift) & (kBuckets - 1); };
    for (const KeyedItem& item : items) ++begin[digit(item)];
    std::uint32_t sum = 0;
    for (std::uint32_t& count : begin) {
      const std::uint32_t size = count;
      count = sum;
      sum += size;
    }
    for (const KeyedItem& item : items) other[begin[digit(item)]++] = item;
    items.swap(other);
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

  std::uint64_t pack(const Position& p) const {
    const auto offset = [&](std::size_t a) { return static_cast<std::uint64_t>(p[a] - min_[a]); };
    return ((offset(2) << bits_[1] | offset(1)) << bits_[0]) | offset(0);
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

/// Calls visit(begin, end) for each run of equal keys.
template <class Visitor>
void forEachRun(const std::vector<KeyedItem>& items, Visitor&& visit) {
  for (std::size_t begin = 0; begin < items.size();) {
    std::size_t end = begin + 1;
    while (end < items.size() && items[end].key == items[begin].key) ++end;
    visit(begin, end);
    begin = end;
  }
}

}  // namespace csom::detail
