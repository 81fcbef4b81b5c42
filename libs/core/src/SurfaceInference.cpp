// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceInference.h"

#include <csom/core/ClassEntropy.h>
#include <csom/core/LocalSurface.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>

#include "ChunkTasks.h"
#include "ClassMass.h"
#include "Counts.h"
#include "FixedPointLanes.h"
#include "KernelMass.h"
#include "Parallel.h"
#include "SurfaceClasses.h"
#include "SurfaceEvidence.h"
#include "VoxelRuns.h"

namespace csom::detail {

namespace {

/// The chunks along an axis in which voxel centres may be nearer to a block than a reach.
struct AxisReach {
  AxisReach(std::int32_t block, int block_side, float reach)
      : lower(block * block_side),
        upper(lower + block_side),
        first((lower - static_cast<int>(std::ceil(reach))) >> kChunkBits),
        last((upper - 1 + static_cast<int>(std::ceil(reach))) >> kChunkBits) {}

  /// Square of the least distance along the axis from the block to a voxel centre of a chunk.
  float gapSquared(int chunk) const {
    const int below = lower - (chunk + 1) * kChunkSide;
    const int above = chunk * kChunkSide - upper;
    const float gap = std::max(0.0F, static_cast<float>(std::max(below, above)) + 0.5F);
    return gap * gap;
  }

  int lower;  ///< voxels of the block: lower … upper − 1
  int upper;
  int first;  ///< chunks
  int last;
};

CSOM_EVERY_PROCESSOR
void countsOf(const std::array<float, kLanes>& mass, double scale, CountLanes& counts) {
  toCounts(__builtin_convertvector(load(mass.data()), MassLanes) * scale, counts);
}

class SurfaceInference {
 public:
  SurfaceInference(const PreparedScan& scan, const Options& options)
      : scan_(scan),
        options_(options),
        points_(scan),
        surfaces_(localSurfaces(scan, options)),
        groups_(laneGroups(scan.block_depth)),
        block_side_(1 << (scan.block_depth - 1)),
        blocks_per_chunk_(kChunkSide / block_side_),
        longest_of_classes_(inVoxels(options.usesClassEntropy() ? options.kernelLengthMax()
                                                                : options.kernelLengthFixed())) {}

  ScanIncrements run(ScanReport& report) {
    const std::vector<ChunkTask> tasks = blocksByChunkInReach();
    ScanIncrements out(tasks.size());
    std::atomic<std::size_t> voxels{0};
    std::atomic<std::size_t> blocks{0};
    parallelRanges(tasks.size(), options_.threads, [&](std::size_t begin, std::size_t end) {
      Scratch scratch(options_);
      for (std::size_t i = begin; i < end; ++i) {
        blocks += fillChunk(tasks[i], scratch);
        voxels += scratch.runs.voxelCount();
        out[i] = {tasks[i].chunk, scratch.runs.take()};
      }
    });
    report.blocks_filled += blocks;
    report.voxels_updated += voxels;
    return out;
  }

 private:
  struct Scratch {
    explicit Scratch(const Options& options)
        : evidence(options),
          classes_of_hits(options),
          class_mass(static_cast<std::size_t>(options.number_of_classes)) {}
    SurfaceEvidence evidence;
    std::array<std::int32_t, kVoxelsPerChunk> observed{};  ///< see markObserved()
    SurfaceClasses classes_of_hits;
    VoxelRuns runs;
    std::vector<double> class_mass;
    std::vector<ClassId> classes;    ///< of a group of voxels
    std::vector<CountLanes> counts;  ///< of each of them
  };

  float inVoxels(double length) const {
    return static_cast<float>(length) / static_cast<float>(options_.resolution);
  }
  BlockIndex cornerOf(const ChunkIndex& chunk) const {
    return {chunk.x * blocks_per_chunk_, chunk.y * blocks_per_chunk_, chunk.z * blocks_per_chunk_};
  }

  /// Lists in blocks_ each observed block with every chunk that its points may say something about.
  std::vector<ChunkTask> blocksByChunkInReach() {
    std::vector<FilledBlock> pairs;  // index: any block of the chunk; observed: the block
    for (std::size_t b = 0; b < scan_.blocks.size(); ++b) {
      float reach = longest_of_classes_;
      for (std::uint32_t p = scan_.block_begin[b]; p < scan_.block_begin[b + 1]; ++p)
        reach = std::max(reach, surfaces_[p].reach() + SurfaceEvidence::kShell);
      const BlockIndex& block = scan_.blocks[b];
      const AxisReach x(block.x, block_side_, reach);
      const AxisReach y(block.y, block_side_, reach);
      const AxisReach z(block.z, block_side_, reach);
      for (int cz = z.first; cz <= z.last; ++cz)
        for (int cy = y.first; cy <= y.last; ++cy)
          for (int cx = x.first; cx <= x.last; ++cx)
            if (x.gapSquared(cx) + y.gapSquared(cy) + z.gapSquared(cz) < reach * reach &&
                isAddressable(ChunkIndex{cx, cy, cz}))
              pairs.push_back({cornerOf({cx, cy, cz}), static_cast<std::int32_t>(b)});
    }
    std::vector<ChunkTask> tasks = groupByChunk(pairs, scan_.block_depth);
    blocks_.clear();
    blocks_.reserve(pairs.size());
    for (const FilledBlock& pair : pairs) blocks_.push_back(pair.observed);
    return tasks;
  }

  /// Returns how many blocks of the chunk were filled.
  std::size_t fillChunk(const ChunkTask& task, Scratch& scratch) const {
    scratch.evidence.reset(task.chunk);
    for (std::size_t i = task.begin; i < task.end; ++i) {
      const auto b = static_cast<std::size_t>(blocks_[i]);
      scratch.evidence.add(points_, surfaces_, scan_.block_begin[b], scan_.block_begin[b + 1]);
    }
    if (!scratch.evidence.finish()) return 0;
    gatherHits(task, scratch);
    markObserved(task, scratch);
    const BlockIndex first = cornerOf(task.chunk);
    std::size_t filled = 0;
    for (int z = 0; z < blocks_per_chunk_; ++z)
      for (int y = 0; y < blocks_per_chunk_; ++y)
        for (int x = 0; x < blocks_per_chunk_; ++x)
          filled += fillBlock({first.x + x, first.y + y, first.z + z}, scratch) ? 1 : 0;
    return filled;
  }

  void gatherHits(const ChunkTask& task, Scratch& scratch) const {
    scratch.classes_of_hits.clear();
    for (std::size_t i = task.begin; i < task.end; ++i) {
      const auto b = static_cast<std::size_t>(blocks_[i]);
      scratch.classes_of_hits.add(points_, surfaces_, scan_.scores, scan_.block_begin[b],
                                  scan_.block_begin[b + 1]);
    }
  }

  std::size_t numberInChunk(const BlockIndex& block) const {
    const int mask = blocks_per_chunk_ - 1;
    return static_cast<std::size_t>(((block.z & mask) * blocks_per_chunk_ + (block.y & mask)) *
                                        blocks_per_chunk_ +
                                    (block.x & mask));
  }

  /// For each block of the chunk, the observed block that it is, or −1.
  void markObserved(const ChunkTask& task, Scratch& scratch) const {
    scratch.observed.fill(-1);
    for (std::size_t i = task.begin; i < task.end; ++i) {
      const BlockIndex& block = scan_.blocks[static_cast<std::size_t>(blocks_[i])];
      if (chunkOfBlock(block, scan_.block_depth) == task.chunk)
        scratch.observed[numberInChunk(block)] = blocks_[i];
    }
  }

  bool fillBlock(const BlockIndex& block, Scratch& scratch) const {
    const int side = block_side_;
    const std::size_t lanes = side > 1 ? kLanes : 1;
    bool any = false;
    bool selected = false;
    for (const LaneGroup& group : groups_) {
      std::array<int, kLanes> voxel{};
      std::array<float, kLanes> occupied{};
      std::array<float, kLanes> free{};
      float any_occupied = 0;
      float any_free = 0;
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        const VoxelIndex& v = group.voxel[lane];
        voxel[lane] =
            indexInChunk({block.x * side + v.x, block.y * side + v.y, block.z * side + v.z});
        any_occupied += occupied[lane] = scratch.evidence.occupied(voxel[lane]);
        any_free += free[lane] = scratch.evidence.free(voxel[lane]);
      }
      if (any_occupied + any_free <= 0) continue;
      any = true;
      if (any_occupied > 0 && !selected) {
        scratch.classes_of_hits.select(placeOf(block), lengthOf(block, scratch));
        selected = true;
      }
      count(group, free, occupied, any_occupied > 0, scratch);
      for (std::size_t lane = 0; lane < lanes; ++lane)
        scratch.runs.add(voxel[lane], scratch.classes.data(), scratch.classes.size(),
                         [&](std::size_t i) { return scratch.counts[i][lane]; });
    }
    return any;
  }

  /// (S4) and (S5) for the voxels of a group: counts by class. Where all hits are of one class, no
  /// sums are needed.
  void count(const LaneGroup& group, const std::array<float, kLanes>& free,
             const std::array<float, kLanes>& occupied, bool any_occupied, Scratch& scratch) const {
    scratch.classes.assign(1, kFreeClass);
    scratch.counts.resize(1);
    countsOf(free, options_.kernel_scale, scratch.counts[0]);
    if (!any_occupied) return;
    if (const std::optional<ClassId> only = scratch.classes_of_hits.onlyClass()) {
      scratch.classes.push_back(*only);
      scratch.counts.resize(2);
      countsOf(occupied, options_.kernel_scale, scratch.counts[1]);
    } else {
      scratch.classes_of_hits.divide(group, occupied, options_.kernel_scale, scratch.classes,
                                     scratch.counts);
    }
  }

  BlockPlace placeOf(const BlockIndex& block) const {
    const int depth_bits = scan_.block_depth - 1;
    return {fixedPoint(block.x) << depth_bits, fixedPoint(block.y) << depth_bits,
            fixedPoint(block.z) << depth_bits, fixedPoint(block_side_)};
  }

  /// L_J of eq. (15) [voxels].
  float lengthOf(const BlockIndex& block, Scratch& scratch) const {
    const std::int32_t observed = scratch.observed[numberInChunk(block)];
    float entropy = 1;
    if (observed >= 0) {
      sumClassMass(scan_, static_cast<std::size_t>(observed), scratch.class_mass);
      entropy = classEntropy(scratch.class_mass);
    }
    return inVoxels(static_cast<double>(kernelLength(entropy, options_)));
  }

  const PreparedScan& scan_;
  const Options& options_;
  PointColumns points_;
  std::vector<LocalSurface> surfaces_;
  std::vector<LaneGroup> groups_;
  std::vector<std::int32_t> blocks_;  ///< observed blocks, by the chunk that they matter to
  int block_side_;                    ///< voxels
  int blocks_per_chunk_;
  float longest_of_classes_;  ///< kernel of the classes, at most [voxels]
};

}  // namespace

ScanIncrements surfaceIncrements(const PreparedScan& scan, const Options& options,
                                 ScanReport& report) {
  return SurfaceInference(scan, options).run(report);
}

}  // namespace csom::detail
