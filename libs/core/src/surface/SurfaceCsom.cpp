// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/ClassEntropy.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>

#include "inference/ChunkTasks.h"
#include "inference/ClassMass.h"
#include "inference/Counts.h"
#include "inference/FixedPointLanes.h"
#include "inference/Inference.h"
#include "inference/KernelMass.h"
#include "inference/VoxelRuns.h"
#include "surface/LocalSurface.h"
#include "surface/SurfaceClasses.h"
#include "surface/SurfaceEvidence.h"
#include "util/Parallel.h"

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
void toScaledCounts(const std::array<float, kLanes>& mass, double scale, CountLanes& counts) {
  toCounts(__builtin_convertvector(load(mass.data()), MassLanes) * scale, counts);
}

/// Every hit p_i has a kernel k_i along its local surface and a density ρ_i (LocalSurface.h). For
/// the centre v of a voxel, with the sums over the scan's hits, the hits H inside the voxel, and
/// the kernel mass F of free samples:
///
///     V = Σ_{surfaces through v} k_i(v) + w_hit·H
///     S = Σ_{surfaces near v} k_i(v) + w_hit·H                                          (S2)
///     M = max(0, 2τ − S),   g = (g_min + (1 − g_min)·(1 − M/2τ))·min(1, S/0.3)          (S3)
///     Δσ^0 = g·w_counter·(S − V + ρ·M) + max(0, 1 − S/τ)·min(F, F_max)                  (S4)
///     Δσ^k = g·V·m^k/Σm for k ≥ 1                                                       (S5)
///
/// ρ is the mean of ρ_i over S, and m^k = Σ_{hits of class k} k(‖v − p_i‖/max(L_J, reach_i)) the
/// kernel mass of eqs. (16)–(21), no hit's kernel being shorter than its surface's.
///
/// So a voxel is occupied, as far as this scan goes, if at least half of the surfaces that could
/// pass through it do, and if they are more than τ. Both verdicts are evidence.
class SurfaceInference {
 public:
  SurfaceInference(const PreparedScan& scan, const Options& options)
      : scan_(scan),
        options_(options),
        points_(scan),
        surfaces_(computeLocalSurfaces(scan, options)),
        groups_(laneGroups(scan.layout)),
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
  struct BlockInReach {
    ChunkIndex chunk;     ///< that points of the block may change
    std::uint32_t block;  ///< of the scan
  };

  /// Lists in blocks_ each observed block with every chunk that its points may change.
  std::vector<ChunkTask> blocksByChunkInReach() {
    std::vector<BlockInReach> in_reach;
    for (std::size_t b = 0; b < scan_.blocks.size(); ++b) {
      float reach = longest_of_classes_;
      for (std::uint32_t p = scan_.block_begin[b]; p < scan_.block_begin[b + 1]; ++p)
        reach = std::max(reach, surfaces_[p].reach() + SurfaceEvidence::kShell);
      const BlockIndex& block = scan_.blocks[b];
      const AxisReach x(block.x, scan_.layout.side(), reach);
      const AxisReach y(block.y, scan_.layout.side(), reach);
      const AxisReach z(block.z, scan_.layout.side(), reach);
      for (int cz = z.first; cz <= z.last; ++cz)
        for (int cy = y.first; cy <= y.last; ++cy)
          for (int cx = x.first; cx <= x.last; ++cx)
            if (x.gapSquared(cx) + y.gapSquared(cy) + z.gapSquared(cz) < reach * reach &&
                isAddressable(ChunkIndex{cx, cy, cz}))
              in_reach.push_back({{cx, cy, cz}, static_cast<std::uint32_t>(b)});
    }
    std::vector<ChunkTask> tasks =
        groupByChunk(in_reach, [](const BlockInReach& b) { return b.chunk; });
    blocks_.clear();
    blocks_.reserve(in_reach.size());
    for (const BlockInReach& b : in_reach) blocks_.push_back(b.block);
    return tasks;
  }

  /// Returns how many blocks of the chunk were filled.
  std::size_t fillChunk(const ChunkTask& task, Scratch& scratch) const {
    scratch.evidence.reset(task.chunk);
    for (std::size_t i = task.begin; i < task.end; ++i) {
      const std::uint32_t b = blocks_[i];
      scratch.evidence.add(points_, surfaces_, scan_.block_begin[b], scan_.block_begin[b + 1]);
    }
    if (!scratch.evidence.finish()) return 0;
    gatherHits(task, scratch);
    markObserved(task, scratch);
    const BlockIndex first = scan_.layout.firstBlock(task.chunk);
    const int blocks_per_chunk = scan_.layout.blocksPerChunk();
    std::size_t filled = 0;
    for (int z = 0; z < blocks_per_chunk; ++z)
      for (int y = 0; y < blocks_per_chunk; ++y)
        for (int x = 0; x < blocks_per_chunk; ++x)
          filled += fillBlock({first.x + x, first.y + y, first.z + z}, scratch) ? 1 : 0;
    return filled;
  }

  void gatherHits(const ChunkTask& task, Scratch& scratch) const {
    scratch.classes_of_hits.clear();
    for (std::size_t i = task.begin; i < task.end; ++i) {
      const std::uint32_t b = blocks_[i];
      scratch.classes_of_hits.add(points_, surfaces_, scan_.scores, scan_.block_begin[b],
                                  scan_.block_begin[b + 1]);
    }
  }

  /// For each block of the chunk, the observed block that it is, or −1.
  void markObserved(const ChunkTask& task, Scratch& scratch) const {
    scratch.observed.fill(-1);
    for (std::size_t i = task.begin; i < task.end; ++i) {
      const BlockIndex& block = scan_.blocks[blocks_[i]];
      if (scan_.layout.chunkOf(block) == task.chunk)
        scratch.observed[scan_.layout.indexInChunk(block)] = static_cast<std::int32_t>(blocks_[i]);
    }
  }

  bool fillBlock(const BlockIndex& block, Scratch& scratch) const {
    const std::size_t lanes = scan_.layout.side() > 1 ? kLanes : 1;
    const VoxelIndex first = scan_.layout.firstVoxel(block);
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
        voxel[lane] = indexInChunk({first.x + v.x, first.y + v.y, first.z + v.z});
        any_occupied += occupied[lane] = scratch.evidence.occupied(voxel[lane]);
        any_free += free[lane] = scratch.evidence.free(voxel[lane]);
      }
      if (any_occupied + any_free <= 0) continue;
      any = true;
      if (any_occupied > 0 && !selected) {
        scratch.classes_of_hits.select(blockPlace(scan_.layout, block),
                                       computeKernelLength(block, scratch));
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
    toScaledCounts(free, options_.kernel.scale, scratch.counts[0]);
    if (!any_occupied) return;
    if (const std::optional<ClassId> only = scratch.classes_of_hits.onlyClass()) {
      scratch.classes.push_back(*only);
      scratch.counts.resize(2);
      toScaledCounts(occupied, options_.kernel.scale, scratch.counts[1]);
    } else {
      scratch.classes_of_hits.divide(group, occupied, options_.kernel.scale, scratch.classes,
                                     scratch.counts);
    }
  }

  /// L_J of eq. (15) [voxels].
  float computeKernelLength(const BlockIndex& block, Scratch& scratch) const {
    const std::int32_t observed = scratch.observed[scan_.layout.indexInChunk(block)];
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
  std::vector<std::uint32_t> blocks_;  ///< observed blocks, by the chunk that they may change
  float longest_of_classes_;           ///< kernel of the classes, at most [voxels]
};

}  // namespace

ScanIncrements inferSurfaceCsom(const PreparedScan& scan, const Options& options,
                                ScanReport& report) {
  return SurfaceInference(scan, options).run(report);
}

}  // namespace csom::detail
