// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceInference.h"

#include <csom/core/ClassEntropy.h>
#include <csom/core/LocalSurface.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include "ChunkTasks.h"
#include "ClassMass.h"
#include "KernelMass.h"
#include "NearbyBlocks.h"
#include "Parallel.h"
#include "SurfaceEvidence.h"
#include "VoxelRuns.h"

namespace csom::detail {

namespace {

/// g_min: what a scan's word is worth where it has seen next to nothing.
constexpr double kLeastWeight = 0.3;
/// Where no surface passes through a voxel and so little passes near it, nothing is said.
constexpr float kLeastSupport = 0.3F;
constexpr float kVoxelCenterInset = 0.5F;

class SurfaceInference {
 public:
  SurfaceInference(const PreparedScan& scan, const Options& options)
      : scan_(scan),
        options_(options),
        points_(scan),
        surfaces_(localSurfaces(scan, options)),
        rows_(scan),
        groups_(laneGroups(scan.block_depth)),
        block_side_(1 << (scan.block_depth - 1)),
        blocks_per_chunk_(kChunkSide / block_side_) {
    float longest = inVoxels(options.usesClassEntropy() ? options.kernelLengthMax()
                                                        : options.kernelLengthFixed());
    for (const LocalSurface& s : surfaces_)
      longest = std::max(longest, s.length + s.half_thickness);
    class_reach_ = NearbyBlocks::reachOf(longest, block_side_, kVoxelCenterInset);
  }

  ScanIncrements run(ScanReport& report) {
    const std::vector<ChunkTask> tasks = blocksByChunkInReach();
    const std::vector<std::size_t> runs = runsOf(tasks);
    ScanIncrements out(tasks.size());
    std::atomic<std::size_t> voxels{0};
    std::atomic<std::size_t> blocks{0};
    parallelRanges(runs.size() - 1, options_.threads, [&](std::size_t begin, std::size_t end) {
      Scratch scratch(options_, block_side_, class_reach_);
      for (std::size_t run = begin; run < end; ++run) {
        const BlockIndex corner = cornerOf(tasks[runs[run]].chunk);
        const BlockIndex last = cornerOf(tasks[runs[run + 1] - 1].chunk);
        scratch.window.moveTo(rows_, corner, last.x - corner.x + blocks_per_chunk_,
                              blocks_per_chunk_, class_reach_);
        for (std::size_t i = runs[run]; i < runs[run + 1]; ++i) {
          blocks += fillChunk(tasks[i], corner, scratch);
          voxels += scratch.runs.voxelCount();
          out[i] = {tasks[i].chunk, scratch.runs.take()};
        }
      }
    });
    report.blocks_filled += blocks;
    report.voxels_updated += voxels;
    return out;
  }

 private:
  struct Scratch {
    Scratch(const Options& options, int block_side, int reach)
        : nearby(block_side, reach, kVoxelCenterInset),
          evidence(static_cast<float>(options.surface_hit_weight)),
          sums(options.number_of_classes),
          class_mass(static_cast<std::size_t>(options.number_of_classes)) {}
    BlockWindow window;
    NearbyBlocks nearby;
    SurfaceEvidence evidence;
    std::array<std::int32_t, kVoxelsPerChunk> observed{};  ///< see markObserved()
    std::vector<PointRange> ranges;
    std::vector<std::uint32_t> selected;
    LaneSums sums;
    VoxelRuns runs;
    std::vector<double> class_mass;
    std::vector<ClassId> classes;
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
      float reach = 0;
      for (std::uint32_t p = scan_.block_begin[b]; p < scan_.block_begin[b + 1]; ++p)
        reach = std::max(reach, surfaces_[p].length + surfaces_[p].half_thickness + 1);
      const int voxels = static_cast<int>(std::ceil(reach));
      const auto chunks = [&](std::int32_t block) {
        return std::pair<int, int>{(block * block_side_ - voxels) >> kChunkBits,
                                   (block * block_side_ + block_side_ - 1 + voxels) >> kChunkBits};
      };
      const auto [x0, x1] = chunks(scan_.blocks[b].x);
      const auto [y0, y1] = chunks(scan_.blocks[b].y);
      const auto [z0, z1] = chunks(scan_.blocks[b].z);
      for (int z = z0; z <= z1; ++z)
        for (int y = y0; y <= y1; ++y)
          for (int x = x0; x <= x1; ++x)
            if (isAddressable(ChunkIndex{x, y, z}))
              pairs.push_back({cornerOf({x, y, z}), static_cast<std::int32_t>(b)});
    }
    std::vector<ChunkTask> tasks = groupByChunk(pairs, scan_.block_depth);
    blocks_.clear();
    blocks_.reserve(pairs.size());
    for (const FilledBlock& pair : pairs) blocks_.push_back(pair.observed);
    return tasks;
  }

  /// `corner` is that of the window. Returns how many blocks of the chunk were filled.
  std::size_t fillChunk(const ChunkTask& task, const BlockIndex& corner, Scratch& scratch) const {
    scratch.evidence.reset(task.chunk);
    for (std::size_t i = task.begin; i < task.end; ++i) {
      const auto b = static_cast<std::size_t>(blocks_[i]);
      scratch.evidence.add(points_, surfaces_, scan_.block_begin[b], scan_.block_begin[b + 1]);
    }
    markObserved(task, scratch);
    const BlockIndex first = cornerOf(task.chunk);
    std::size_t filled = 0;
    for (int z = 0; z < blocks_per_chunk_; ++z)
      for (int y = 0; y < blocks_per_chunk_; ++y)
        for (int x = 0; x < blocks_per_chunk_; ++x) {
          const BlockIndex block{first.x + x, first.y + y, first.z + z};
          filled += fillBlock(block, corner, scratch) ? 1 : 0;
        }
    return filled;
  }

  std::size_t numberInChunk(const BlockIndex& block) const {
    const int mask = blocks_per_chunk_ - 1;
    return static_cast<std::size_t>(
        ((block.z & mask) * blocks_per_chunk_ + (block.y & mask)) * blocks_per_chunk_ +
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

  bool fillBlock(const BlockIndex& block, const BlockIndex& corner, Scratch& scratch) const {
    const SurfaceEvidence& evidence = scratch.evidence;
    const int side = block_side_;
    const std::size_t lanes = side > 1 ? kLanes : 1;
    bool any = false;
    float length = 0;  // of the classes' kernel, once it is needed
    for (const LaneGroup& group : groups_) {
      std::array<int, kLanes> voxel{};
      bool votes = false;
      bool says = false;
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        const VoxelIndex& v = group.voxel[lane];
        voxel[lane] =
            indexInChunk({block.x * side + v.x, block.y * side + v.y, block.z * side + v.z});
        votes = votes || evidence.votes(voxel[lane]) > 0;
        says = says || evidence.support(voxel[lane]) >= kLeastSupport ||
               evidence.free(voxel[lane]) > 0;
      }
      if (!votes && !says) continue;
      any = true;
      scratch.sums.reset();
      if (votes) {
        if (length == 0) length = selectForClasses(block, corner, scratch);
        addKernelMass(options_.kernel, points_, scratch.selected, scan_.scores, group,
                      placeOf(block), length, scratch.sums);
      }
      const std::vector<ClassId>& found = scratch.sums.finish();
      scratch.classes.assign(1, kFreeClass);
      for (const ClassId k : found)
        if (k != kFreeClass) scratch.classes.push_back(k);
      for (std::size_t lane = 0; lane < lanes; ++lane) store(voxel[lane], lane, scratch);
    }
    return any;
  }

  BlockPlace placeOf(const BlockIndex& block) const {
    const int depth_bits = scan_.block_depth - 1;
    return {fixedPoint(block.x) << depth_bits, fixedPoint(block.y) << depth_bits,
            fixedPoint(block.z) << depth_bits, fixedPoint(block_side_)};
  }

  /// Selects the points that tell a block's classes, and returns the kernel length [voxels]: L_J of
  /// eq. (15), or longer, so that what votes also tells a class.
  float selectForClasses(const BlockIndex& block, const BlockIndex& corner,
                         Scratch& scratch) const {
    const std::int32_t observed = scratch.observed[numberInChunk(block)];
    float entropy = 1;
    if (observed >= 0) {
      sumClassMass(scan_, static_cast<std::size_t>(observed), scratch.class_mass);
      entropy = classEntropy(scratch.class_mass);
    }
    float length = inVoxels(static_cast<double>(kernelLength(entropy, options_)));
    const int side = block_side_;
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
          length = std::max(length, scratch.evidence.reach(indexInChunk(
                                        {block.x * side + x, block.y * side + y,
                                         block.z * side + z})));
    listRanges(scratch.window, {block.x - corner.x, block.y - corner.y, block.z - corner.z},
               scratch.nearby.within(length), scratch.ranges);
    selectNearby(points_, scratch.ranges, placeOf(block), length, scratch.selected);
    return length;
  }

  void store(int voxel, std::size_t lane, Scratch& scratch) const {
    const double votes = static_cast<double>(scratch.evidence.votes(voxel));
    const double support = static_cast<double>(scratch.evidence.support(voxel));
    const double free = static_cast<double>(scratch.evidence.free(voxel));
    const double full = 2 * options_.surface_support;
    double mass = 0;
    for (std::size_t i = 1; i < scratch.classes.size(); ++i)
      mass += scratch.sums.mass(scratch.classes[i], lane);
    const bool has_votes = votes > 0 && mass > 0;
    double weight = kLeastWeight + (1 - kLeastWeight) * std::min(1.0, support / full);
    if (!has_votes && support < static_cast<double>(kLeastSupport)) weight = 0;
    const double density = static_cast<double>(scratch.evidence.density(voxel));
    const double against =
        support - (has_votes ? votes : 0) + density * std::max(0.0, full - support);
    const double scale = options_.kernel_scale;
    const double share = has_votes ? scale * weight * votes / mass : 0;
    scratch.runs.add(voxel, scratch.classes.data(), scratch.classes.size(), [&](ClassId k) {
      if (k == kFreeClass)
        return toCount(scale * (weight * options_.counter_evidence * against + free));
      return toCount(share * scratch.sums.mass(k, lane));
    });
  }

  const PreparedScan& scan_;
  const Options& options_;
  PointColumns points_;
  std::vector<LocalSurface> surfaces_;
  BlockRows rows_;
  std::vector<LaneGroup> groups_;
  std::vector<std::int32_t> blocks_;  ///< observed blocks, by the chunk that they matter to
  int block_side_;                    ///< voxels
  int blocks_per_chunk_;
  int class_reach_ = 1;  ///< blocks
};

}  // namespace

ScanIncrements surfaceIncrements(const PreparedScan& scan, const Options& options,
                                 ScanReport& report) {
  return SurfaceInference(scan, options).run(report);
}

}  // namespace csom::detail
