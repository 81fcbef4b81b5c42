// SPDX-License-Identifier: BSD-3-Clause
// Metric ↔ voxel ↔ block ↔ chunk, in one place. Everything rounds down (floor), negative
// coordinates included; the centre of voxel i is at (i+½)·r.
#pragma once

#include <csom/core/types.h>

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace csom {

constexpr int kChunkBits = 3;
constexpr int kChunkSide = 1 << kChunkBits;
constexpr int kVoxelsPerChunk = kChunkSide * kChunkSide * kChunkSide;

/// Chunk indices have 21 bits an axis: ±8,388,600 voxels from the map's origin (1,677 km at 0.2 m).
constexpr std::int32_t kMaxChunkIndex = (1 << 20) - 1;
inline bool isAddressable(const ChunkIndex& c) {
  const auto inside = [](std::int32_t i) { return i >= -kMaxChunkIndex && i <= kMaxChunkIndex; };
  return inside(c.x) && inside(c.y) && inside(c.z);
}

/// The voxels that these hold.
constexpr std::int32_t kFirstVoxelIndex = -kMaxChunkIndex * kChunkSide;
constexpr std::int32_t kLastVoxelIndex = kMaxChunkIndex * kChunkSide + kChunkSide - 1;

/// Points stay 1024 voxels away from the last chunk, so that kernels around them need no check.
constexpr std::int32_t kMaxVoxelIndex = kMaxChunkIndex * kChunkSide - 1024;

inline std::int32_t chunkOf(std::int32_t voxel) {
  return voxel >> kChunkBits;
}
inline ChunkIndex chunkOf(const VoxelIndex& v) {
  return {chunkOf(v.x), chunkOf(v.y), chunkOf(v.z)};
}

/// Position of a voxel inside its chunk: x + 8·y + 64·z, 0 … 511.
inline int indexInChunk(const VoxelIndex& v) {
  constexpr int mask = kChunkSide - 1;
  return (v.x & mask) | ((v.y & mask) << kChunkBits) | ((v.z & mask) << (2 * kChunkBits));
}
inline VoxelIndex voxelOfChunk(const ChunkIndex& c, int index_in_chunk) {
  constexpr int mask = kChunkSide - 1;
  return {c.x * kChunkSide + (index_in_chunk & mask),
          c.y * kChunkSide + ((index_in_chunk >> kChunkBits) & mask),
          c.z * kChunkSide + (index_in_chunk >> (2 * kChunkBits))};
}

/// How blocks lie on the grid of voxels and in chunks: a block is 2^(D_b−1) voxels a side.
class BlockLayout {
 public:
  /// `depth` is D_b, 1 … 4.
  explicit constexpr BlockLayout(int depth) : bits_(depth - 1), side_(1 << bits_) {}

  int side() const { return side_; }                          ///< voxels
  int sideBits() const { return bits_; }                      ///< log₂ of it
  int blocksPerChunk() const { return kChunkSide >> bits_; }  ///< along an axis

  BlockIndex blockOf(const VoxelIndex& v) const {
    return {v.x >> bits_, v.y >> bits_, v.z >> bits_};
  }
  /// The voxel at its lower corner.
  VoxelIndex firstVoxel(const BlockIndex& b) const {
    return {b.x * side_, b.y * side_, b.z * side_};
  }

  ChunkIndex chunkOf(const BlockIndex& b) const {
    const int shift = kChunkBits - bits_;
    return {b.x >> shift, b.y >> shift, b.z >> shift};
  }
  /// The block at its lower corner.
  BlockIndex firstBlock(const ChunkIndex& c) const {
    const int blocks = blocksPerChunk();
    return {c.x * blocks, c.y * blocks, c.z * blocks};
  }
  /// Position of a block inside its chunk, x first.
  std::size_t indexInChunk(const BlockIndex& b) const {
    const int blocks = blocksPerChunk();
    const int mask = blocks - 1;
    return static_cast<std::size_t>(((b.z & mask) * blocks + (b.y & mask)) * blocks + (b.x & mask));
  }

 private:
  int bits_;
  int side_;
};

/// The voxel grid of edge `resolution` [m].
class Grid {
 public:
  explicit Grid(double resolution) : resolution_(resolution) {}

  double resolution() const { return resolution_; }

  /// True if a point may lie there (see kMaxVoxelIndex); false for NaN and infinities.
  bool contains(const Eigen::Vector3d& point) const {
    const double limit = resolution_ * kMaxVoxelIndex;
    return point.cwiseAbs().maxCoeff() <= limit && point.allFinite();
  }
  /// True if there is a voxel at a point, although no point of a scan may lie there; false for NaN
  /// and infinities.
  bool isAddressable(const Eigen::Vector3d& point) const {
    for (const double coordinate : point) {
      const double voxel = std::floor(coordinate / resolution_);
      if (!(voxel >= kFirstVoxelIndex && voxel <= kLastVoxelIndex)) return false;
    }
    return true;
  }
  /// Requires contains(point) or isAddressable(point).
  VoxelIndex voxelAt(const Eigen::Vector3d& point) const {
    return {indexOf(point.x()), indexOf(point.y()), indexOf(point.z())};
  }
  /// Division, not multiplication by 1/r: i·r then falls into voxel i for every i.
  std::int32_t indexOf(double coordinate) const {
    return static_cast<std::int32_t>(std::floor(coordinate / resolution_));
  }
  Eigen::Vector3d center(const VoxelIndex& v) const {
    return {(v.x + 0.5) * resolution_, (v.y + 0.5) * resolution_, (v.z + 0.5) * resolution_};
  }
  Eigen::Vector3d lowerCorner(const VoxelIndex& v) const {
    return {v.x * resolution_, v.y * resolution_, v.z * resolution_};
  }

 private:
  double resolution_;
};

}  // namespace csom
