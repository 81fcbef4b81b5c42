// SPDX-License-Identifier: BSD-3-Clause
// Chunk indices as single numbers, for sorting and for tables.
#pragma once

#include <csom/core/types.h>

#include <cstddef>
#include <cstdint>

namespace csom::detail {

constexpr int kChunkKeyAxisBits = 21;

/// Order of keys = z-major order of indices.
inline std::uint64_t chunkKey(const ChunkIndex& index) {
  constexpr std::int32_t kOffset = 1 << (kChunkKeyAxisBits - 1);
  constexpr std::uint64_t kMask = (std::uint64_t{1} << kChunkKeyAxisBits) - 1;
  const auto axis = [](std::int32_t i) { return static_cast<std::uint64_t>(i + kOffset) & kMask; };
  return (axis(index.z) << (2 * kChunkKeyAxisBits)) | (axis(index.y) << kChunkKeyAxisBits) |
         axis(index.x);
}
inline ChunkIndex chunkOfKey(std::uint64_t key) {
  constexpr std::int32_t kOffset = 1 << (kChunkKeyAxisBits - 1);
  constexpr std::uint64_t kMask = (std::uint64_t{1} << kChunkKeyAxisBits) - 1;
  const auto axis = [](std::uint64_t bits) {
    return static_cast<std::int32_t>(bits & kMask) - kOffset;
  };
  return {axis(key), axis(key >> kChunkKeyAxisBits), axis(key >> (2 * kChunkKeyAxisBits))};
}

/// Where a key belongs in a table of a power of two of slots, whose number is this & (slots − 1).
/// Multiplicative hashing: the high bits of key·2^64/φ are well mixed.
inline std::size_t mixedKey(std::uint64_t key) {
  return static_cast<std::size_t>((key * 0x9E3779B97F4A7C15ull) >> 32U);
}

}  // namespace csom::detail
