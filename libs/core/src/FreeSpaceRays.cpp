// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/FreeSpaceRays.h>

#include <array>
#include <map>

#include "VoxelRuns.h"
#include "VoxelTraversal.h"

namespace csom {

namespace {

/// A set of voxels: a bit each, by chunk.
class VoxelSet {
 public:
  using Bits = std::array<std::uint64_t, kVoxelsPerChunk / 64>;

  void insert(const VoxelIndex& voxel) { word(voxel) |= bit(voxel); }
  void erase(const VoxelIndex& voxel) { word(voxel) &= ~bit(voxel); }
  const std::map<ChunkIndex, Bits>& chunks() const { return chunks_; }

 private:
  static std::uint64_t bit(const VoxelIndex& v) {
    return std::uint64_t{1} << (static_cast<unsigned>(indexInChunk(v)) & 63U);
  }
  std::uint64_t& word(const VoxelIndex& voxel) {
    const ChunkIndex chunk = chunkOf(voxel);
    if (last_bits_ == nullptr ||
        last_chunk_ != chunk) {  // a beam stays in a chunk for several voxels
      last_chunk_ = chunk;
      last_bits_ = &chunks_[chunk];
    }
    return (*last_bits_)[static_cast<std::size_t>(indexInChunk(voxel)) >> 6U];
  }

  std::map<ChunkIndex, Bits> chunks_;
  ChunkIndex last_chunk_;
  Bits* last_bits_ = nullptr;
};

}  // namespace

ScanIncrements castFreeSpace(const PreparedScan& scan, const Options& options, ScanReport& report) {
  const Grid grid(options.resolution);
  VoxelSet crossed;
  for (const Eigen::Vector3d& end : scan.beam_ends) {
    detail::traverseVoxels(grid, scan.origin, end, [&](const VoxelIndex& voxel, double) {
      crossed.insert(voxel);
      return true;
    });
  }
  for (const Eigen::Vector3d& end : scan.beam_ends) crossed.erase(grid.voxelAt(end));
  for (const VoxelIndex& voxel : scan.hit_voxels) crossed.erase(voxel);

  ScanIncrements out;
  const std::uint32_t count = detail::toCount(options.free_weight);
  for (const auto& [chunk, bits] : crossed.chunks()) {
    ChunkIncrements increments{chunk, {}};
    for (std::size_t word = 0; word < bits.size(); ++word) {
      for (std::uint64_t left = bits[word]; left != 0; left &= left - 1) {
        const auto voxel =
            static_cast<std::uint16_t>(word * 64 + static_cast<std::size_t>(__builtin_ctzll(left)));
        increments.increments.push_back({voxel, kFreeClass, count});
      }
    }
    report.free_voxels += increments.increments.size();
    if (!increments.increments.empty()) out.push_back(std::move(increments));
  }
  return out;
}

}  // namespace csom
