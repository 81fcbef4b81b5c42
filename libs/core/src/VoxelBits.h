// SPDX-License-Identifier: BSD-3-Clause
// A set of voxels near each other: a bit each, by chunk.
#pragma once

#include <csom/core/Grid.h>
#include <csom/core/types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace csom::detail {

/// A voxel as one integer: indexInChunk() in the lowest bits, above them the chunk, 13 bits an
/// axis. Each axis has bits of its own, so codes of axes are put together by `or`.
using VoxelCode = std::uint64_t;
constexpr int kInChunkBits = 3 * kChunkBits;

inline VoxelCode chunkOfCode(VoxelCode voxel) {
  return voxel >> kInChunkBits;
}

/// Codes of voxels at most 2¹⁵−8 from a voxel along each axis.
class VoxelCoder {
 public:
  explicit VoxelCoder(const VoxelIndex& center)
      : first_{chunkOf(center.x) - kReach, chunkOf(center.y) - kReach, chunkOf(center.z) - kReach} {
  }

  VoxelCode code(int axis, std::int32_t index) const {
    const auto chunk =
        static_cast<VoxelCode>(chunkOf(index) - first_[static_cast<std::size_t>(axis)]);
    const auto in_chunk = static_cast<VoxelCode>(index & (kChunkSide - 1));
    return chunk << (kInChunkBits + kAxisBits * axis) | in_chunk << (kChunkBits * axis);
  }
  VoxelCode code(const VoxelIndex& v) const { return code(0, v.x) | code(1, v.y) | code(2, v.z); }

  ChunkIndex chunk(VoxelCode chunk) const {
    const auto axis = [&](int a) {
      const VoxelCode bits = chunk >> (kAxisBits * a) & ((VoxelCode{1} << kAxisBits) - 1);
      return static_cast<std::int32_t>(bits) + first_[static_cast<std::size_t>(a)];
    };
    return {axis(0), axis(1), axis(2)};
  }

 private:
  static constexpr int kAxisBits = 13;
  static constexpr std::int32_t kReach = 1 << (kAxisBits - 1);
  std::array<std::int32_t, 3> first_;
};

class VoxelBits {
 public:
  using Bits = std::array<std::uint64_t, kVoxelsPerChunk / 64>;

  static void set(Bits& bits, VoxelCode voxel) { bits[wordOf(voxel)] |= bitOf(voxel); }

  /// The bits of a chunk, all 0 if it is new; valid until the next call.
  Bits& of(VoxelCode chunk) {
    if (4 * (chunks_.size() + 1) > 3 * slots_.size()) grow();
    std::uint32_t& slot = slots_[slotOf(chunk)];
    if (slot == kEmpty) {
      slot = static_cast<std::uint32_t>(chunks_.size());
      chunks_.push_back({chunk, {}});
    }
    return chunks_[slot].second;
  }

  void insert(const VoxelBits& other) {
    for (const auto& [chunk, bits] : other.chunks_) {
      Bits& own = of(chunk);
      for (std::size_t word = 0; word < bits.size(); ++word) own[word] |= bits[word];
    }
  }
  void erase(VoxelCode voxel) {
    if (chunks_.empty()) return;
    const std::uint32_t slot = slots_[slotOf(chunkOfCode(voxel))];
    if (slot != kEmpty) chunks_[slot].second[wordOf(voxel)] &= ~bitOf(voxel);
  }

  template <class Visitor>
  void forEachChunk(Visitor&& visit) const {
    for (const auto& [chunk, bits] : chunks_) visit(chunk, bits);
  }

 private:
  static constexpr std::uint32_t kEmpty = ~std::uint32_t{0};

  static std::size_t wordOf(VoxelCode voxel) {
    return static_cast<std::size_t>(voxel >> 6U) % (kVoxelsPerChunk / 64);
  }
  static std::uint64_t bitOf(VoxelCode voxel) { return std::uint64_t{1} << (voxel & 63U); }

  std::size_t slotOf(VoxelCode chunk) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = static_cast<std::size_t>((chunk * 0x9E3779B97F4A7C15ull) >> 32U) & mask;
    while (slots_[slot] != kEmpty && chunks_[slots_[slot]].first != chunk) slot = (slot + 1) & mask;
    return slot;
  }
  void grow() {
    slots_.assign(slots_.empty() ? 1024 : 2 * slots_.size(), kEmpty);
    for (std::size_t i = 0; i < chunks_.size(); ++i)
      slots_[slotOf(chunks_[i].first)] = static_cast<std::uint32_t>(i);
  }

  std::vector<std::pair<VoxelCode, Bits>> chunks_;
  std::vector<std::uint32_t> slots_;  ///< open addressing: positions in chunks_
};

}  // namespace csom::detail
