// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/ClassEntropy.h>
#include <csom/core/ContextEntropy.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "inference/BlockNeighbours.h"
#include "inference/BlockWindow.h"
#include "inference/ChunkTasks.h"
#include "inference/ClassMass.h"
#include "inference/Inference.h"
#include "inference/KernelMass.h"
#include "inference/NearbyBlocks.h"
#include "inference/VoxelRuns.h"
#include "util/Parallel.h"

namespace csom::detail {

namespace {

/// A class entropy up to which only the points of a block itself count
/// (Neighbourhood::ExtendedBlock).
constexpr float kPureBlockEntropy = 0.3F;
/// A voxel's centre is half a voxel inside its block.
constexpr float kVoxelCenterInset = 0.5F;

/// For the centre v_j of each voxel of each filled block, over the training points within L_J:
///
///     Δσ_j^k = Σ_i ε0·k(‖v_j − p_i‖ / L_J)·c_i^k                        (16)–(21)
///
/// summed in single precision in the order of the points (z-major by block), rounded once to the
/// quantum. s-bki is the same without both entropies.
class SeeCsomInference {
 public:
  SeeCsomInference(const PreparedScan& scan, const Options& options)
      : scan_(scan),
        options_(options),
        rows_(scan),
        points_(scan),
        groups_(laneGroups(scan.layout)),
        neighbours_(extendedBlock(options.see_csom.context_neighbours)),
        reach_(
            options.see_csom.neighbourhood == Neighbourhood::ExtendedBlock
                ? 1
                : NearbyBlocks::reachOf(longestKernel(), scan_.layout.side(), kVoxelCenterInset)),
        extended_block_{halfWidthsOfExtendedBlock(true), halfWidthsOfExtendedBlock(false)} {}

  ScanIncrements run(ScanReport& report) {
    filled_ = filledBlocks(scan_.blocks, options_);
    report.blocks_filled += filled_.size();
    const std::vector<ChunkTask> tasks = groupByChunk(
        filled_, [&](const FilledBlock& block) { return scan_.layout.chunkOf(block.index); });
    const std::vector<std::size_t> runs = findRuns(tasks);
    ScanIncrements out(tasks.size());
    std::atomic<std::size_t> voxels{0};
    parallelRanges(runs.size() - 1, options_.threads, [&](std::size_t begin, std::size_t end) {
      Scratch scratch(options_.number_of_classes, scan_.layout.side(), reach_);
      for (std::size_t run = begin; run < end; ++run) {
        const BlockIndex corner = scan_.layout.firstBlock(tasks[runs[run]].chunk);
        const BlockIndex last = scan_.layout.firstBlock(tasks[runs[run + 1] - 1].chunk);
        scratch.window.moveTo(rows_, corner, last.x - corner.x + scan_.layout.blocksPerChunk(),
                              scan_.layout.blocksPerChunk(), reach_);
        for (std::size_t i = runs[run]; i < runs[run + 1]; ++i) {
          fillChunk(tasks[i], corner, scratch);
          voxels += scratch.runs.voxelCount();
          out[i] = {tasks[i].chunk, scratch.runs.take()};
        }
      }
    });
    report.voxels_updated += voxels;
    return out;
  }

 private:
  /// What a thread needs while it works.
  struct Scratch {
    Scratch(int classes, int block_side, int reach)
        : nearby(block_side, reach, kVoxelCenterInset),
          sums(classes),
          class_mass(static_cast<std::size_t>(classes)) {}
    BlockWindow window;
    NearbyBlocks nearby;
    std::vector<PointRange> ranges;
    std::vector<std::uint32_t> selected;
    LaneSums sums;
    std::vector<CountLanes> counts;  ///< of the classes that `sums` lists
    VoxelRuns runs;
    std::vector<double> class_mass;
  };

  /// Kernel lengths in voxels.
  float inVoxels(float length) const { return length / static_cast<float>(options_.resolution); }
  float longestKernel() const {
    return inVoxels(static_cast<float>(options_.usesClassEntropy() ? options_.kernelLengthMax()
                                                                   : options_.kernelLengthFixed()));
  }

  /// `corner` is that of the window.
  void fillChunk(const ChunkTask& task, const BlockIndex& corner, Scratch& scratch) const {
    for (std::size_t i = task.begin; i < task.end; ++i) {
      const FilledBlock& block = filled_[i];
      const BlockIndex in_window{block.index.x - corner.x, block.index.y - corner.y,
                                 block.index.z - corner.z};
      const BlockPlace place = blockPlace(scan_.layout, block.index);
      const float entropy = computeClassEntropy(block, scratch.class_mass);
      const float length = inVoxels(kernelLength(entropy, options_));
      listRanges(scratch.window, in_window,
                 options_.see_csom.neighbourhood == Neighbourhood::Radius
                     ? scratch.nearby.within(length)
                     : extended_block_[entropy <= kPureBlockEntropy ? 0 : 1],
                 scratch.ranges);
      selectNearby(points_, scratch.ranges, place, length, scratch.selected);
      for (const LaneGroup& group : groups_) {
        sumKernelMass(options_.kernel.shape, points_, scratch.selected, scan_.scores, group, place,
                      length, options_.kernel.scale, scratch.sums, scratch.counts);
        store(block.index, group, scratch);
      }
    }
  }

  /// E_cla of the points of the block itself.
  float computeClassEntropy(const FilledBlock& block, std::vector<double>& class_mass) const {
    if (block.observed < 0) return 1.0F;
    sumClassMass(scan_, static_cast<std::size_t>(block.observed), class_mass);
    return classEntropy(class_mass);
  }

  /// The block alone, or with the neighbours of its extended block.
  HalfWidths halfWidthsOfExtendedBlock(bool alone) const {
    HalfWidths found;
    for (int z = -reach_; z <= reach_; ++z)
      for (int y = -reach_; y <= reach_; ++y) {
        int x = -1;
        for (const BlockOffset& d : neighbours_) {
          if (d.y == y && d.z == z && (!alone || d.kind() == 0)) x = std::max(x, d.x);
        }
        found.push_back(x);
      }
    return found;
  }

  void store(const BlockIndex& block, const LaneGroup& group, Scratch& scratch) const {
    const std::vector<ClassId>& classes = scratch.sums.classes();
    const std::size_t lanes = scan_.layout.side() > 1 ? kLanes : 1;
    const VoxelIndex first = scan_.layout.firstVoxel(block);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const VoxelIndex& v = group.voxel[lane];
      scratch.runs.add(indexInChunk({first.x + v.x, first.y + v.y, first.z + v.z}), classes.data(),
                       classes.size(), [&](std::size_t i) { return scratch.counts[i][lane]; });
    }
  }

  const PreparedScan& scan_;
  const Options& options_;
  BlockRows rows_;
  PointColumns points_;
  std::vector<LaneGroup> groups_;
  std::vector<BlockOffset> neighbours_;
  std::vector<FilledBlock> filled_;
  int reach_;
  /// The block alone, and with its neighbours.
  std::array<HalfWidths, 2> extended_block_;
};

}  // namespace

ScanIncrements inferSeeCsom(const PreparedScan& scan, const Options& options, ScanReport& report) {
  return SeeCsomInference(scan, options).run(report);
}

}  // namespace csom::detail
