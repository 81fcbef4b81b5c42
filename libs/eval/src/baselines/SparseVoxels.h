// SPDX-License-Identifier: BSD-3-Clause
// A value for each voxel that was written to, in chunks of 8 voxels a side.
#pragma once

#include <csom/core/Grid.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_map>

namespace csom::detail {

template <class Value>
class SparseVoxels {
 public:
  /// The value of a voxel, made by its default constructor when first asked for.
  Value& operator[](const VoxelIndex& voxel) {
    const std::uint64_t key = keyOf(chunkOf(voxel));
    // Neighbouring voxels are asked for one after another.
    if (last_ == nullptr || key != last_key_) {
      std::unique_ptr<Chunk>& chunk = chunks_[key];
      if (!chunk) chunk = std::make_unique<Chunk>();
      last_ = chunk.get();
      last_key_ = key;
    }
    return (*last_)[static_cast<std::size_t>(indexInChunk(voxel))];
  }

  /// Null if nothing near the voxel was ever written to.
  const Value* find(const VoxelIndex& voxel) const {
    const auto chunk = chunks_.find(keyOf(chunkOf(voxel)));
    return chunk == chunks_.end()
               ? nullptr
               : &(*chunk->second)[static_cast<std::size_t>(indexInChunk(voxel))];
  }

 private:
  using Chunk = std::array<Value, kVoxelsPerChunk>;

  static std::uint64_t keyOf(const ChunkIndex& c) {
    const auto bits = [](std::int32_t i) {
      return static_cast<std::uint64_t>(std::int64_t{i} + kMaxChunkIndex + 1);
    };
    return bits(c.x) | bits(c.y) << 21 | bits(c.z) << 42;
  }

  std::unordered_map<std::uint64_t, std::unique_ptr<Chunk>> chunks_;
  Chunk* last_ = nullptr;
  std::uint64_t last_key_ = 0;
};

}  // namespace csom::detail
