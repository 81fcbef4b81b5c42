// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/ClassEntropy.h>
#include <csom/core/ContextEntropy.h>
#include <csom/core/KernelInference.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

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

std::vector<LaneGroup> laneGroups(int block_depth) {
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
          const auto centre = [](std::int32_t voxel) {
            return detail::fixedPoint(voxel) + detail::kFixedPointVoxel / 2;
          };
          group.x[l] = centre(group.voxel[l].x);
          group.y[l] = centre(group.voxel[l].y);
          group.z[l] = centre(group.voxel[l].z);
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
        points_(scan),
        groups_(laneGroups(scan.block_depth)),
        neighbours_(detail::extendedBlock(options.context_neighbours)),
        blocks_per_chunk_(kChunkSide >> (scan.block_depth - 1)),
        block_side_(1 << (scan.block_depth - 1)),
        reach_(options.neighbourhood == Neighbourhood::ExtendedBlock
                   ? 1
                   : std::max(1, reachOf(longestKernel()))) {
    for (int offset = 0; offset <= reach_; ++offset) {
      const float gap = offset == 0 ? 0.0F : static_cast<float>((offset - 1) * block_side_) + 0.5F;
      gaps_squared_.push_back(gap * gap);
    }
  }

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
  /// Blocks next to each other, as offsets into the window's starts from those of a block.
  struct RowOfBlocks {
    std::ptrdiff_t row;  ///< the same for the window's rows
    std::ptrdiff_t first;
    std::ptrdiff_t last;
  };
  /// What a thread needs while it works.
  struct Scratch {
    explicit Scratch(int classes) : sums(classes), class_mass(static_cast<std::size_t>(classes)) {}
    detail::BlockWindow window;
    std::vector<std::vector<RowOfBlocks>> rows;  ///< around any block; see rowsWithin()
    std::vector<detail::PointRange> ranges;
    std::vector<std::uint32_t> selected;
    detail::LaneSums sums;
    detail::VoxelRuns runs;
    std::vector<double> class_mass;
  };

  /// Kernel lengths in voxels.
  float inVoxels(float length) const { return length / static_cast<float>(options_.resolution); }
  float longestKernel() const {
    return inVoxels(static_cast<float>(options_.usesClassEntropy() ? options_.kernelLengthMax()
                                                                   : options_.kernelLengthFixed()));
  }
  /// Blocks that a kernel of this length can reach: a voxel's centre is half a voxel inside its
  /// block.
  int reachOf(float length) const {
    return static_cast<int>(std::ceil((length - 0.5F) / static_cast<float>(block_side_)));
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
    std::vector<detail::KeyedItem<std::uint64_t>> sorted(filled_.size());
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
    const BlockIndex corner{task.chunk.x * blocks_per_chunk_, task.chunk.y * blocks_per_chunk_,
                            task.chunk.z * blocks_per_chunk_};
    scratch.window.moveTo(rows_, corner, blocks_per_chunk_, reach_);
    for (std::size_t i = task.begin; i < task.end; ++i) {
      const FilledBlock& block = filled_[i];
      const BlockIndex in_chunk{block.index.x - corner.x, block.index.y - corner.y,
                                block.index.z - corner.z};
      const int depth_bits = scan_.block_depth - 1;
      const detail::BlockPlace place{detail::fixedPoint(block.index.x) << depth_bits,
                                     detail::fixedPoint(block.index.y) << depth_bits,
                                     detail::fixedPoint(block.index.z) << depth_bits,
                                     detail::fixedPoint(block_side_)};
      const float entropy = classEntropyOf(block, scratch.class_mass);
      const float length = inVoxels(kernelLength(entropy, options_));
      findNeighbourhood(in_chunk, entropy, length, scratch);
      detail::selectNearby(points_, scratch.ranges, place, length, scratch.selected);
      for (const LaneGroup& group : groups_) {
        scratch.sums.reset();
        detail::addKernelMass(options_.kernel, points_, scratch.selected, scan_.scores, group,
                              place, length, scratch.sums);
        store(block.index, group, scratch);
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

  /// The ranges of points that may matter to a block of the chunk, z-major by block.
  void findNeighbourhood(const BlockIndex& block, float entropy, float length,
                         Scratch& scratch) const {
    const std::vector<RowOfBlocks>& rows = options_.neighbourhood == Neighbourhood::Radius
                                               ? rowsWithin(length, scratch)
                                               : rowsOfExtendedBlock(entropy, scratch);
    scratch.ranges.clear();
    const std::uint32_t* const here = scratch.window.startsAt(block.x, block.y, block.z);
    const std::uint8_t* const observed = scratch.window.observedAt(block.y, block.z);
    for (const RowOfBlocks& row : rows) {
      if (observed[row.row] == 0) continue;
      const std::uint32_t begin = here[row.first];
      const std::uint32_t end = here[row.last + 1];
      if (begin < end) scratch.ranges.push_back({begin, end});
    }
  }

  /// Rows of blocks that may hold a point nearer than `length` to a voxel centre. Lengths share
  /// their rows by quarters of a voxel, rounded up: points too far are sorted out later.
  const std::vector<RowOfBlocks>& rowsWithin(float length, Scratch& scratch) const {
    constexpr float kSteps = 4;
    const auto step = static_cast<std::size_t>(std::ceil(length * kSteps));
    if (scratch.rows.size() <= step) scratch.rows.resize(step + 1);
    std::vector<RowOfBlocks>& rows = scratch.rows[step];
    if (!rows.empty()) return rows;
    const float longest = static_cast<float>(step) / kSteps;
    const float limit = longest * longest;
    for (int z = -reach_; z <= reach_; ++z)
      for (int y = -reach_; y <= reach_; ++y) {
        int x = -1;
        while (x < reach_ && gapSquared(x + 1) + gapSquared(y) + gapSquared(z) < limit) ++x;
        if (x >= 0)
          rows.push_back({scratch.window.rowStride(y, z), scratch.window.stride(-x, y, z),
                          scratch.window.stride(x, y, z)});
      }
    return rows;
  }

  /// The block alone, or with the neighbours of its extended block.
  const std::vector<RowOfBlocks>& rowsOfExtendedBlock(float entropy, Scratch& scratch) const {
    scratch.rows.resize(2);
    const bool alone = entropy <= kPureBlockEntropy;
    std::vector<RowOfBlocks>& rows = scratch.rows[alone ? 0 : 1];
    if (!rows.empty()) return rows;
    for (const detail::BlockOffset& d : neighbours_) {
      const std::ptrdiff_t at = scratch.window.stride(d.x, d.y, d.z);
      if (!alone || d.kind() == 0) rows.push_back({scratch.window.rowStride(d.y, d.z), at, at});
    }
    return rows;
  }

  /// Square of the least distance along one axis from a voxel centre of a block to a block so many
  /// blocks away.
  float gapSquared(int offset) const {
    return gaps_squared_[static_cast<std::size_t>(std::abs(offset))];
  }

  void store(const BlockIndex& block, const LaneGroup& group, Scratch& scratch) const {
    const int side = block_side_;
    const std::vector<ClassId>& classes = scratch.sums.finish();
    const std::size_t lanes = side > 1 ? kLanes : 1;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const VoxelIndex& v = group.voxel[lane];
      scratch.runs.add(
          indexInChunk({block.x * side + v.x, block.y * side + v.y, block.z * side + v.z}),
          classes.data(), classes.size(), [&](ClassId k) {
            return detail::toCount(options_.kernel_scale * scratch.sums.mass(k, lane));
          });
    }
  }

  const float* scoresOf(std::uint32_t point) const {
    return scan_.scores.data() +
           static_cast<std::size_t>(point) * static_cast<std::size_t>(options_.number_of_classes);
  }

  const PreparedScan& scan_;
  const Options& options_;
  detail::BlockRows rows_;
  detail::PointColumns points_;
  std::vector<LaneGroup> groups_;
  std::vector<detail::BlockOffset> neighbours_;
  std::vector<FilledBlock> filled_;
  int blocks_per_chunk_;
  int block_side_;  ///< voxels
  int reach_;
  std::vector<float> gaps_squared_;
};

/// s-csm: each observed voxel receives the class mass of its own points.
ScanIncrements countPoints(const PreparedScan& scan, const Options& options, ScanReport& report) {
  const auto classes = static_cast<std::size_t>(options.number_of_classes);
  detail::KeyPacking packing;
  for (const BlockIndex& voxel : scan.blocks) {
    packing.include({chunkOf(voxel.x), chunkOf(voxel.y), chunkOf(voxel.z)});
  }
  packing.finish();
  std::vector<detail::KeyedItem<std::uint64_t>> sorted;
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
  std::vector<ClassId> all_classes(classes);
  std::iota(all_classes.begin(), all_classes.end(), ClassId{0});
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
      runs.add(indexInChunk({voxel.x, voxel.y, voxel.z}), all_classes.data(), classes,
               [&](ClassId k) { return detail::toCount(mass[k]); });
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
