// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/FreeSpaceRays.h>

#include <array>
#include <cstddef>
#include <mutex>
#include <unordered_map>
#include <utility>

#include "Parallel.h"
#include "VoxelRuns.h"
#include "VoxelTraversal.h"

namespace csom {

namespace {

/// A set of voxels: a bit each, by chunk.
class VoxelSet {
 public:
  using Bits = std::array<std::uint64_t, kVoxelsPerChunk / 64>;

  void insert(const VoxelIndex& voxel) {
    Bits& bits = of(chunkOf(voxel));
    bits[wordOf(voxel)] |= bitOf(voxel);
  }
  void erase(const VoxelIndex& voxel) {
    const auto found = chunks_.find(chunkOf(voxel));
    if (found != chunks_.end()) found->second[wordOf(voxel)] &= ~bitOf(voxel);
  }
  void insert(const VoxelSet& other) {
    for (const auto& [chunk, bits] : other.chunks_) {
      Bits& own = of(chunk);
      for (std::size_t word = 0; word < bits.size(); ++word) own[word] |= bits[word];
    }
  }
  template <class Visitor>
  void forEachChunk(Visitor&& visit) const {
    for (const auto& [chunk, bits] : chunks_) visit(chunk, bits);
  }

 private:
  struct Hash {
    std::size_t operator()(const ChunkIndex& c) const {
      const auto mix = [](std::int32_t i, std::uint64_t factor) {
        return static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) * factor;
      };
      const std::uint64_t sum = mix(c.x, 0x9E3779B97F4A7C15ull) + mix(c.y, 0xC2B2AE3D27D4EB4Full) +
                                mix(c.z, 0x165667B19E3779F9ull);
      return static_cast<std::size_t>(sum >> 20U);
    }
  };

  static std::size_t wordOf(const VoxelIndex& v) {
    return static_cast<std::size_t>(indexInChunk(v)) >> 6U;
  }
  static std::uint64_t bitOf(const VoxelIndex& v) {
    return std::uint64_t{1} << (static_cast<unsigned>(indexInChunk(v)) & 63U);
  }
  Bits& of(const ChunkIndex& chunk) {
    if (last_ == nullptr || last_chunk_ != chunk) {  // a beam stays in a chunk for several voxels
      last_chunk_ = chunk;
      last_ = &chunks_[chunk];
    }
    return *last_;
  }

  std::unordered_map<ChunkIndex, Bits, Hash> chunks_;
  ChunkIndex last_chunk_;
  Bits* last_ = nullptr;  ///< elements of an unordered_map stay where they are
};

VoxelSet crossedVoxels(const PreparedScan& scan, const Options& options) {
  const Grid grid(options.resolution);
  VoxelSet crossed;
  std::mutex mutex;
  // Unions commute: however the beams are divided, the set is the same.
  detail::parallelRanges(scan.beam_ends.size(), options.threads,
                         [&](std::size_t begin, std::size_t end) {
                           VoxelSet part;
                           for (std::size_t beam = begin; beam < end; ++beam) {
                             detail::traverseVoxels(grid, scan.origin, scan.beam_ends[beam],
                                                    [&](const VoxelIndex& voxel, double) {
                                                      part.insert(voxel);
                                                      return true;
                                                    });
                           }
                           const std::lock_guard<std::mutex> lock(mutex);
                           crossed.insert(part);
                         });
  for (const Eigen::Vector3d& end : scan.beam_ends) crossed.erase(grid.voxelAt(end));
  for (const VoxelIndex& voxel : scan.hit_voxels) crossed.erase(voxel);
  return crossed;
}

}  // namespace

ScanIncrements castFreeSpace(const PreparedScan& scan, const Options& options, ScanReport& report) {
  ScanIncrements out;
  const std::uint32_t count = detail::toCount(options.free_weight);
  crossedVoxels(scan, options)
      .forEachChunk([&](const ChunkIndex& chunk, const VoxelSet::Bits& bits) {
        ChunkIncrements increments{chunk, {}};
        for (std::size_t word = 0; word < bits.size(); ++word) {
          for (std::uint64_t left = bits[word]; left != 0; left &= left - 1) {
            const auto voxel = static_cast<std::uint16_t>(
                word * 64 + static_cast<std::size_t>(__builtin_ctzll(left)));
            increments.increments.push_back({voxel, kFreeClass, count});
          }
        }
        report.free_voxels += increments.increments.size();
        if (!increments.increments.empty()) out.push_back(std::move(increments));
      });
  return out;
}

}  // namespace csom
