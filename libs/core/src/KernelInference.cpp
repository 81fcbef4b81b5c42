// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/ClassEntropy.h>
#include <csom/core/ContextEntropy.h>
#include <csom/core/KernelInference.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>

#include "BlockNeighbours.h"
#include "BlockWindow.h"
#include "ChunkTasks.h"
#include "ClassMass.h"
#include "Counts.h"
#include "KernelMass.h"
#include "NearbyBlocks.h"
#include "Parallel.h"
#include "SortedKeys.h"
#include "SurfaceInference.h"
#include "VoxelRuns.h"

namespace csom {

namespace {

using detail::ChunkTask;
using detail::kLanes;
using detail::LaneGroup;

/// A class entropy up to which a block listens to itself alone (Neighbourhood::ExtendedBlock).
constexpr float kPureBlockEntropy = 0.3F;
/// A voxel's centre is half a voxel inside its block.
constexpr float kVoxelCenterInset = 0.5F;

class Inference {
 public:
  Inference(const PreparedScan& scan, const Options& options)
      : scan_(scan),
        options_(options),
        rows_(scan),
        points_(scan),
        groups_(detail::laneGroups(scan.block_depth)),
        neighbours_(detail::extendedBlock(options.context_neighbours)),
        blocks_per_chunk_(kChunkSide >> (scan.block_depth - 1)),
        block_side_(1 << (scan.block_depth - 1)),
        reach_(
            options.neighbourhood == Neighbourhood::ExtendedBlock
                ? 1
                : detail::NearbyBlocks::reachOf(longestKernel(), block_side_, kVoxelCenterInset)),
        extended_block_{halfWidthsOfExtendedBlock(true), halfWidthsOfExtendedBlock(false)} {}

  ScanIncrements run(ScanReport& report) {
    filled_ = filledBlocks(scan_.blocks, options_);
    report.blocks_filled += filled_.size();
    const std::vector<ChunkTask> tasks = detail::groupByChunk(filled_, scan_.block_depth);
    const std::vector<std::size_t> runs = detail::runsOf(tasks);
    ScanIncrements out(tasks.size());
    std::atomic<std::size_t> voxels{0};
    detail::parallelRanges(
        runs.size() - 1, options_.threads, [&](std::size_t begin, std::size_t end) {
          Scratch scratch(options_.number_of_classes, block_side_, reach_);
          for (std::size_t run = begin; run < end; ++run) {
            const BlockIndex corner = cornerOf(tasks[runs[run]].chunk);
            const BlockIndex last = cornerOf(tasks[runs[run + 1] - 1].chunk);
            scratch.window.moveTo(rows_, corner, last.x - corner.x + blocks_per_chunk_,
                                  blocks_per_chunk_, reach_);
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
    detail::BlockWindow window;
    detail::NearbyBlocks nearby;
    std::vector<detail::PointRange> ranges;
    std::vector<std::uint32_t> selected;
    detail::LaneSums sums;
    std::vector<detail::CountLanes> counts;  ///< of the classes that `sums` lists
    detail::VoxelRuns runs;
    std::vector<double> class_mass;
  };

  /// Kernel lengths in voxels.
  float inVoxels(float length) const { return length / static_cast<float>(options_.resolution); }
  float longestKernel() const {
    return inVoxels(static_cast<float>(options_.usesClassEntropy() ? options_.kernelLengthMax()
                                                                   : options_.kernelLengthFixed()));
  }
  BlockIndex cornerOf(const ChunkIndex& chunk) const {
    return {chunk.x * blocks_per_chunk_, chunk.y * blocks_per_chunk_, chunk.z * blocks_per_chunk_};
  }

  /// `corner` is that of the window.
  void fillChunk(const ChunkTask& task, const BlockIndex& corner, Scratch& scratch) const {
    for (std::size_t i = task.begin; i < task.end; ++i) {
      const FilledBlock& block = filled_[i];
      const BlockIndex in_window{block.index.x - corner.x, block.index.y - corner.y,
                                 block.index.z - corner.z};
      const int depth_bits = scan_.block_depth - 1;
      const detail::BlockPlace place{detail::fixedPoint(block.index.x) << depth_bits,
                                     detail::fixedPoint(block.index.y) << depth_bits,
                                     detail::fixedPoint(block.index.z) << depth_bits,
                                     detail::fixedPoint(block_side_)};
      const float entropy = classEntropyOf(block, scratch.class_mass);
      const float length = inVoxels(kernelLength(entropy, options_));
      detail::listRanges(scratch.window, in_window,
                         options_.neighbourhood == Neighbourhood::Radius
                             ? scratch.nearby.within(length)
                             : extended_block_[entropy <= kPureBlockEntropy ? 0 : 1],
                         scratch.ranges);
      detail::selectNearby(points_, scratch.ranges, place, length, scratch.selected);
      for (const LaneGroup& group : groups_) {
        detail::sumKernelMass(options_.kernel, points_, scratch.selected, scan_.scores, group,
                              place, length, options_.kernel_scale, scratch.sums, scratch.counts);
        store(block.index, group, scratch);
      }
    }
  }

  /// E_cla of the points of the block itself.
  float classEntropyOf(const FilledBlock& block, std::vector<double>& class_mass) const {
    if (block.observed < 0) return 1.0F;
    detail::sumClassMass(scan_, static_cast<std::size_t>(block.observed), class_mass);
    return classEntropy(class_mass);
  }

  /// The block alone, or with the neighbours of its extended block.
  detail::HalfWidths halfWidthsOfExtendedBlock(bool alone) const {
    detail::HalfWidths found;
    for (int z = -reach_; z <= reach_; ++z)
      for (int y = -reach_; y <= reach_; ++y) {
        int x = -1;
        for (const detail::BlockOffset& d : neighbours_) {
          if (d.y == y && d.z == z && (!alone || d.kind() == 0)) x = std::max(x, d.x);
        }
        found.push_back(x);
      }
    return found;
  }

  void store(const BlockIndex& block, const LaneGroup& group, Scratch& scratch) const {
    const int side = block_side_;
    const std::vector<ClassId>& classes = scratch.sums.classes();
    const std::size_t lanes = side > 1 ? kLanes : 1;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const VoxelIndex& v = group.voxel[lane];
      scratch.runs.add(
          indexInChunk({block.x * side + v.x, block.y * side + v.y, block.z * side + v.z}),
          classes.data(), classes.size(), [&](std::size_t i) { return scratch.counts[i][lane]; });
    }
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
  /// The block alone, and with its neighbours.
  std::array<detail::HalfWidths, 2> extended_block_;
};

/// s-csm: each observed voxel receives the class mass of its own points.
ScanIncrements countPoints(const PreparedScan& scan, const Options& options, ScanReport& report) {
  const auto classes = static_cast<std::size_t>(options.number_of_classes);
  const auto sorted = detail::sortedByPosition(scan.blocks.size(), [&](std::size_t b) {
    const BlockIndex& voxel = scan.blocks[b];
    return detail::KeyPacking::Position{chunkOf(voxel.x), chunkOf(voxel.y), chunkOf(voxel.z)};
  });

  ScanIncrements out;
  detail::VoxelRuns runs;
  std::vector<double> mass(classes);
  std::vector<ClassId> all_classes(classes);
  std::iota(all_classes.begin(), all_classes.end(), ClassId{0});
  detail::forEachRun(sorted, [&](std::size_t begin, std::size_t end) {
    for (std::size_t entry = begin; entry < end; ++entry) {
      const std::size_t b = sorted[entry].item;
      detail::sumClassMass(scan, b, mass);
      const BlockIndex& voxel = scan.blocks[b];
      runs.add(indexInChunk({voxel.x, voxel.y, voxel.z}), all_classes.data(), classes,
               [&](std::size_t k) { return detail::toCount(mass[k]); });
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
  ScanIncrements increments;
  switch (options.method) {
    case Method::SurfaceCsom:
      increments = detail::surfaceIncrements(scan, options, report);
      break;
    case Method::SeeCsom:
    case Method::SBki:
      increments = Inference(scan, options).run(report);
      break;
    case Method::SCsm:
      increments = countPoints(scan, options, report);
      break;
  }
  increments.erase(
      std::remove_if(increments.begin(), increments.end(),
                     [](const ChunkIncrements& chunk) { return chunk.increments.empty(); }),
      increments.end());
  return increments;
}

}  // namespace csom
