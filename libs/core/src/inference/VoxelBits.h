// SPDX-License-Identifier: BSD-3-Clause
// A set of voxels of a box: a bit each, by chunk.
#pragma once

#include <csom/core/Grid.h>
#include <csom/core/types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "util/ChunkKey.h"

namespace csom::detail {

/// A voxel of a box as one integer: indexInChunk() in the lowest bits, above them the number of its
/// chunk. Each axis contributes a part of its own; the code is their sum.
using VoxelCode = std::uint64_t;
constexpr int kInChunkBits = 3 * kChunkBits;

inline VoxelCode chunkOfCode(VoxelCode voxel) {
  return voxel >> kInChunkBits;
}

/// Codes of the voxels of a box.
class VoxelCoder {
 public:
  explicit VoxelCoder(const VoxelBox& box)
      : first_{chunkOf(box.min.x), chunkOf(box.min.y), chunkOf(box.min.z)} {
    const std::array<std::int32_t, 3> last{chunkOf(box.max.x), chunkOf(box.max.y),
                                           chunkOf(box.max.z)};
    for (std::size_t a = 0; a < 3; ++a) {
      stride_[a] = chunks_;
      size_[a] = static_cast<VoxelCode>(last[a] - first_[a] + 1);
      chunks_ *= size_[a];
    }
  }

  /// Chunks of the box are numbered from 0 to this.
  VoxelCode chunkCount() const { return chunks_; }

  VoxelCode code(int axis, std::int32_t index) const {
    const auto a = static_cast<std::size_t>(axis);
    const auto chunk = static_cast<VoxelCode>(chunkOf(index) - first_[a]);
    const auto in_chunk = static_cast<VoxelCode>(index & (kChunkSide - 1));
    return ((chunk * stride_[a]) << kInChunkBits) + (in_chunk << (kChunkBits * axis));
  }
  VoxelCode code(const VoxelIndex& v) const { return code(0, v.x) + code(1, v.y) + code(2, v.z); }

  ChunkIndex chunk(VoxelCode chunk) const {
    const auto axis = [&](std::size_t a) {
      return static_cast<std::int32_t>(chunk / stride_[a] % size_[a]) + first_[a];
    };
    return {axis(0), axis(1), axis(2)};
  }

 private:
  std::array<std::int32_t, 3> first_;
  std::array<VoxelCode, 3> size_{};
  std::array<VoxelCode, 3> stride_{};
  VoxelCode chunks_ = 1;
};

class VoxelBits {
 public:
  using Bits = std::array<std::uint64_t, kVoxelsPerChunk / 64>;

  /// `chunks`: of the box.
  explicit VoxelBits(VoxelCode chunks)
      : is_dense_(chunks <= kMaxDense),
        slots_(is_dense_ ? static_cast<std::size_t>(chunks) : 1024, kEmpty) {}

  void insert(VoxelCode voxel) {
    const VoxelCode chunk = chunkOfCode(voxel);
    const std::uint32_t slot = slots_[slotOf(chunk)];
    set(slot != kEmpty ? chunks_[slot].second : add(chunk), voxel);
  }
  void insert(const VoxelBits& other) {
    for (const auto& [chunk, bits] : other.chunks_) {
      const std::uint32_t slot = slots_[slotOf(chunk)];
      Bits& own = slot != kEmpty ? chunks_[slot].second : add(chunk);
      for (std::size_t word = 0; word < bits.size(); ++word) own[word] |= bits[word];
    }
  }
  void erase(VoxelCode voxel) {
    const std::uint32_t slot = slots_[slotOf(chunkOfCode(voxel))];
    if (slot != kEmpty) chunks_[slot].second[wordOf(voxel)] &= ~bitOf(voxel);
  }

  /// Calls visit(chunk, bits) for each chunk with a voxel, or that had one.
  template <class Visitor>
  void forEachChunk(Visitor&& visit) const {
    for (const auto& [chunk, bits] : chunks_) visit(chunk, bits);
  }

 private:
  static constexpr std::uint32_t kEmpty = ~std::uint32_t{0};
  /// A box of so many chunks has a slot for each; a larger one is hashed. 16 MB.
  static constexpr VoxelCode kMaxDense = VoxelCode{1} << 22;

  static void set(Bits& bits, VoxelCode voxel) { bits[wordOf(voxel)] |= bitOf(voxel); }
  static std::size_t wordOf(VoxelCode voxel) {
    return static_cast<std::size_t>(voxel >> 6U) % (kVoxelsPerChunk / 64);
  }
  static std::uint64_t bitOf(VoxelCode voxel) { return std::uint64_t{1} << (voxel & 63U); }

  /// Makes a new chunk.
  Bits& add(VoxelCode chunk) {
    if (!is_dense_ && 4 * (chunks_.size() + 1) > 3 * slots_.size()) grow();
    slots_[slotOf(chunk)] = static_cast<std::uint32_t>(chunks_.size());
    chunks_.push_back({chunk, {}});
    return chunks_.back().second;
  }
  std::size_t slotOf(VoxelCode chunk) const {
    return is_dense_ ? static_cast<std::size_t>(chunk) : hashedSlotOf(chunk);
  }
  std::size_t hashedSlotOf(VoxelCode chunk) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = mixedKey(chunk) & mask;
    while (slots_[slot] != kEmpty && chunks_[slots_[slot]].first != chunk) slot = (slot + 1) & mask;
    return slot;
  }
  void grow() {
    slots_.assign(2 * slots_.size(), kEmpty);
    for (std::size_t i = 0; i < chunks_.size(); ++i)
      slots_[hashedSlotOf(chunks_[i].first)] = static_cast<std::uint32_t>(i);
  }

  bool is_dense_;
  std::vector<std::pair<VoxelCode, Bits>> chunks_;
  std::vector<std::uint32_t> slots_;  ///< positions in chunks_, by chunk or by its hash
};

}  // namespace csom::detail
