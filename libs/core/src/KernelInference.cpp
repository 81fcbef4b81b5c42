// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/ClassEntropy.h>
#include <csom/core/ContextEntropy.h>
#include <csom/core/KernelInference.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "BlockNeighbours.h"
#include "BlockWindow.h"
#include "KernelMass.h"
#include "Parallel.h"
#include "SortedKeys.h"
#include "VoxelRuns.h"

namespace csom {

namespace {

using detail::kLanes;
using detail::LaneGroup;

/// A class entropy up to which a block listens to itself alone (Neighbourhood::ExtendedBlock).
constexpr float kPureBlockEntropy = 0.3F;

std::vector<LaneGroup> laneGroups(int block_depth, double resolution) {
  const int side = 1 << (block_depth - 1);
  const int step = side > 1 ? 2 : 1;
  std::vector<LaneGroup> groups;
  for (int z = 0; z < side; z += step)
    for (int y = 0; y < side; y += step)
      for (int x = 0; x < side; x += step) {
        LaneGroup group;
        for (int lane = 0; lane < static_cast<int>(kLanes); ++lane) {
          const auto l = static_cast<std::size_t>(lane);
          group.voxel[l] = side > 1
                               ? VoxelIndex{x + (lane & 1), y + ((lane >> 1) & 1), z + (lane >> 2)}
                               : VoxelIndex{x, y, z};
          group.x[l] = static_cast<float>((group.voxel[l].x + 0.5) * resolution);
          group.y[l] = static_cast<float>((group.voxel[l].y + 0.5) * resolution);
          group.z[l] = static_cast<float>((group.voxel[l].z + 0.5) * resolution);
        }
        groups.push_back(group);
      }
  return groups;
}

/// The filled blocks of one chunk: filled[begin] … filled[end−1].
struct ChunkTask {
  ChunkIndex chunk;
  std::size_t begin = 0;
  std::size_t end = 0;
};

class Inference {
 public:
  Inference(const PreparedScan& scan, const Options& options)
      : scan_(scan),
        options_(options),
        rows_(scan),
        groups_(laneGroups(scan.block_depth, options.resolution)),
        neighbours_(detail::extendedBlock(options.context_neighbours)),
        blocks_per_chunk_(kChunkSide >> (scan.block_depth - 1)),
        block_edge_(static_cast<float>(std::ldexp(options.resolution, scan.block_depth - 1))),
        reach_(std::max(1, reachOf(longestKernel()))) {}

  ScanIncrements run(ScanReport& report) {
    filled_ = filledBlocks(scan_.blocks, options_);
    report.blocks_filled += filled_.size();
    const std::vector<ChunkTask> tasks = groupByChunk();
    ScanIncrements out(tasks.size());
    std::atomic<std::size_t> voxels{0};
    detail::parallelRanges(tasks.size(), options_.threads, [&](std::size_t begin, std::size_t end) {
      Scratch scratch(options_.number_of_classes);
      for (std::size_t i = begin; i < end; ++i) {
        fillChunk(tasks[i], scratch);
        voxels += scratch.runs.voxelCount();
        out[i] = {tasks[i].chunk, scratch.runs.take()};
      }
    });
    report.voxels_updated += voxels;
    return out;
  }

 private:
  /// What a thread needs while it works.
  struct Scratch {
    explicit Scratch(int classes) : sums(classes), class_mass(static_cast<std::size_t>(classes)) {}
    detail::BlockWindow window;
    detail::NearbyPoints nearby;
    detail::LaneSums sums;
    detail::VoxelRuns runs;
    std::vector<double> class_mass;
  };

  float longestKernel() const {
    return options_.usesClassEntropy() ? static_cast<float>(options_.kernelLengthMax())
                                       : static_cast<float>(options_.kernelLengthFixed());
  }
  /// Blocks that a kernel of this length can reach: a voxel's centre is half a voxel inside its
  /// block.
  int reachOf(float length) const {
    const double free = static_cast<double>(length) - options_.resolution / 2;
    return static_cast<int>(std::ceil(free / static_cast<double>(block_edge_) + 1e-6));
  }

  /// Sorts filled_ by chunk; a chunk's blocks stay together because a block lies in one chunk.
  std::vector<ChunkTask> groupByChunk() {
    const int shift = kChunkBits - (scan_.block_depth - 1);
    const auto chunkOfBlock = [shift](const BlockIndex& b) {
      return ChunkIndex{b.x >> shift, b.y >> shift, b.z >> shift};
    };
    detail::KeyPacking packing;
    for (const FilledBlock& block : filled_) {
      const ChunkIndex c = chunkOfBlock(block.index);
      packing.include({c.x, c.y, c.z});
    }
    packing.finish();
    std::vector<detail::KeyedItem> sorted(filled_.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      const ChunkIndex c = chunkOfBlock(filled_[i].index);
      sorted[i] = {packing.pack({c.x, c.y, c.z}), static_cast<std::uint32_t>(i)};
    }
    detail::stableSort(sorted, packing.bits());
    std::vector<FilledBlock> by_chunk;
    by_chunk.reserve(filled_.size());
    std::vector<ChunkTask> tasks;
    detail::forEachRun(sorted, [&](std::size_t begin, std::size_t end) {
      tasks.push_back({chunkOfBlock(filled_[sorted[begin].item].index), begin, end});
      for (std::size_t i = begin; i < end; ++i) by_chunk.push_back(filled_[sorted[i].item]);
    });
    filled_.swap(by_chunk);
    return tasks;
  }

  void fillChunk(const ChunkTask& task, Scratch& scratch) const {
    const auto corner = [&](std::int32_t c) { return c * blocks_per_chunk_ - reach_; };
    scratch.window.moveTo(rows_, {corner(task.chunk.x), corner(task.chunk.y), corner(task.chunk.z)},
                          blocks_per_chunk_ + 2 * reach_);
    for (std::size_t i = task.begin; i < task.end; ++i) {
      const float entropy = classEntropyOf(filled_[i], scratch.class_mass);
      const float length = kernelLength(entropy, options_);
      gatherNeighbourhood(filled_[i], entropy, length, scratch);
      for (const LaneGroup& group : groups_) {
        scratch.sums.reset();
        detail::addKernelMass(options_.kernel, group, scratch.nearby, scan_, length,
                              options_.number_of_classes, scratch.sums);
        store(filled_[i].index, group, scratch);
      }
    }
  }

  /// E_cla of the points of the block itself.
  float classEntropyOf(const FilledBlock& block, std::vector<double>& class_mass) const {
    if (block.observed < 0) return 1.0F;
    std::fill(class_mass.begin(), class_mass.end(), 0.0);
    const auto b = static_cast<std::size_t>(block.observed);
    for (std::uint32_t i = scan_.block_begin[b]; i < scan_.block_begin[b + 1]; ++i) {
      if (scan_.scores.empty()) {
        class_mass[scan_.points[i].label] += 1;
      } else {
        for (std::size_t k = 0; k < class_mass.size(); ++k)
          class_mass[k] += static_cast<double>(scoresOf(i)[k]);
      }
    }
    return classEntropy(class_mass);
  }

  /// Finds the points that the block's voxels listen to, z-major by block.
  void gatherNeighbourhood(const FilledBlock& block, float entropy, float length,
                           Scratch& scratch) const {
    scratch.nearby.reset(block_edge_, static_cast<float>(options_.resolution / 2), length);
    if (options_.neighbourhood == Neighbourhood::ExtendedBlock) {
      const bool alone = entropy <= kPureBlockEntropy;
      for (const detail::BlockOffset& d : neighbours_) {
        if (!alone || d.kind() == 0) gatherRow(block.index, d.x, d.x, d.y, d.z, scratch);
      }
      return;
    }
    const int reach = std::min(reach_, reachOf(length));
    const float limit = length * length;
    for (int z = -reach; z <= reach; ++z)
      for (int y = -reach; y <= reach; ++y) {
        const float yz = gapSquared(y) + gapSquared(z);
        int x = -1;
        while (x < reach && yz + gapSquared(x + 1) < limit) ++x;
        if (x >= 0) gatherRow(block.index, -x, x, y, z, scratch);
      }
  }

  /// Square of the least distance along one axis from a voxel centre of a block to a block `offset`
  /// blocks away, a little too short so that rounding never hides a point.
  float gapSquared(int offset) const {
    if (offset == 0) return 0;
    const float gap = (static_cast<float>(std::abs(offset)) - 1.0F) * block_edge_ +
                      0.499F * static_cast<float>(options_.resolution);
    return gap * gap;
  }

  /// The points of the blocks from x_first to x_last (offsets from `block`) of one row.
  void gatherRow(const BlockIndex& block, int x_first, int x_last, int y, int z,
                 Scratch& scratch) const {
    const std::uint32_t* starts =
        scratch.window.pointsOf(block.x + x_first, block.y + y, block.z + z);
    if (starts[0] == starts[x_last - x_first + 1]) return;
    for (int x = x_first; x <= x_last; ++x, ++starts)
      scratch.nearby.add(scan_.points.data(), starts[0], starts[1],
                         static_cast<float>(x) * block_edge_, static_cast<float>(y) * block_edge_,
                         static_cast<float>(z) * block_edge_);
  }

  void store(const BlockIndex& block, const LaneGroup& group, Scratch& scratch) const {
    if (scratch.sums.empty()) return;
    const int side = 1 << (scan_.block_depth - 1);
    const std::vector<ClassId>& classes = scratch.sums.finish();
    const std::size_t lanes = side > 1 ? kLanes : 1;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const VoxelIndex& v = group.voxel[lane];
      scratch.runs.begin(
          indexInChunk({block.x * side + v.x, block.y * side + v.y, block.z * side + v.z}));
      for (const ClassId k : classes)
        scratch.runs.add(k, options_.kernel_scale * scratch.sums.mass(k, lane));
      scratch.runs.end();
    }
  }

  const float* scoresOf(std::uint32_t point) const {
    return scan_.scores.data() +
           static_cast<std::size_t>(point) * static_cast<std::size_t>(options_.number_of_classes);
  }

  const PreparedScan& scan_;
  const Options& options_;
  detail::BlockRows rows_;
  std::vector<LaneGroup> groups_;
  std::vector<detail::BlockOffset> neighbours_;
  std::vector<FilledBlock> filled_;
  int blocks_per_chunk_;
  float block_edge_;
  int reach_;
};

/// s-csm: each observed voxel receives the class mass of its own points.
ScanIncrements countPoints(const PreparedScan& scan, const Options& options, ScanReport& report) {
  const auto classes = static_cast<std::size_t>(options.number_of_classes);
  detail::KeyPacking packing;
  for (const BlockIndex& voxel : scan.blocks) {
    packing.include({chunkOf(voxel.x), chunkOf(voxel.y), chunkOf(voxel.z)});
  }
  packing.finish();
  std::vector<detail::KeyedItem> sorted;
  sorted.reserve(scan.blocks.size());
  for (std::size_t b = 0; b < scan.blocks.size(); ++b) {
    const BlockIndex& voxel = scan.blocks[b];
    sorted.push_back({packing.pack({chunkOf(voxel.x), chunkOf(voxel.y), chunkOf(voxel.z)}),
                      static_cast<std::uint32_t>(b)});
  }
  detail::stableSort(sorted, packing.bits());

  ScanIncrements out;
  detail::VoxelRuns runs;
  std::vector<double> mass(classes);
  detail::forEachRun(sorted, [&](std::size_t begin, std::size_t end) {
    for (std::size_t entry = begin; entry < end; ++entry) {
      const std::size_t b = sorted[entry].item;
      std::fill(mass.begin(), mass.end(), 0.0);
      for (std::size_t i = scan.block_begin[b]; i < scan.block_begin[b + 1]; ++i) {
        if (scan.scores.empty()) {
          mass[scan.points[i].label] += 1;
        } else {
          for (std::size_t k = 0; k < classes; ++k)
            mass[k] += static_cast<double>(scan.scores[i * classes + k]);
        }
      }
      const BlockIndex& voxel = scan.blocks[b];
      runs.begin(indexInChunk({voxel.x, voxel.y, voxel.z}));
      for (std::size_t k = 0; k < classes; ++k) runs.add(static_cast<ClassId>(k), mass[k]);
      runs.end();
    }
    const BlockIndex& first = scan.blocks[sorted[begin].item];
    report.voxels_updated += runs.voxelCount();
    out.push_back({chunkOf(VoxelIndex{first.x, first.y, first.z}), runs.take()});
  });
  report.blocks_filled += scan.blocks.size();
  return out;
}

}  // namespace

ScanIncrements inferIncrements(const PreparedScan& scan, const Options& options,
                               ScanReport& report) {
  if (scan.blocks.empty()) return {};
  ScanIncrements increments = options.method == Method::SCsm ? countPoints(scan, options, report)
                                                             : Inference(scan, options).run(report);
  increments.erase(
      std::remove_if(increments.begin(), increments.end(),
                     [](const ChunkIncrements& chunk) { return chunk.increments.empty(); }),
      increments.end());
  return increments;
}

}  // namespace csom
