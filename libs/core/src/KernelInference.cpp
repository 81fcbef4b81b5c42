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
    const std::vector<std::size_t> runs = runsOf(tasks);
    ScanIncrements out(tasks.size());
    std::atomic<std::size_t> voxels{0};
    detail::parallelRanges(
        runs.size() - 1, options_.threads, [&](std::size_t begin, std::size_t end) {
          Scratch scratch(options_.number_of_classes);
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
  /// By how many blocks along x, on both sides, each row around a block matters to it; −1 if it
  /// does not. See BlockWindow::offsetOf().
  using HalfWidths = std::vector<int>;

  /// What a thread needs while it works.
  struct Scratch {
    explicit Scratch(int classes) : sums(classes), class_mass(static_cast<std::size_t>(classes)) {}
    detail::BlockWindow window;
    std::vector<HalfWidths> half_widths;  ///< see halfWidthsWithin()
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
    const auto sorted = detail::sortedByPosition(filled_.size(), [&](std::size_t i) {
      const ChunkIndex c = chunkOfBlock(filled_[i].index);
      return detail::KeyPacking::Position{c.x, c.y, c.z};
    });
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

  /// Chunks close to each other along x share a window: tasks runs[i] … runs[i+1]−1.
  static std::vector<std::size_t> runsOf(const std::vector<ChunkTask>& tasks) {
    constexpr std::int32_t kLargestStep = 2;
    std::vector<std::size_t> runs;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      const ChunkIndex& chunk = tasks[i].chunk;
      const ChunkIndex& before = tasks[i > 0 ? i - 1 : 0].chunk;
      if (i == 0 || chunk.y != before.y || chunk.z != before.z || chunk.x - before.x > kLargestStep)
        runs.push_back(i);
    }
    runs.push_back(tasks.size());
    return runs;
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
      findNeighbourhood(in_window, entropy, length, scratch);
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

  /// The ranges of points that may matter to a block of the window, z-major by block.
  void findNeighbourhood(const BlockIndex& block, float entropy, float length,
                         Scratch& scratch) const {
    const HalfWidths& half_widths = options_.neighbourhood == Neighbourhood::Radius
                                        ? halfWidthsWithin(length, scratch)
                                        : halfWidthsOfExtendedBlock(entropy, scratch);
    scratch.ranges.clear();
    for (const detail::BlockWindow::Row& row : scratch.window.rowsAround(block.y, block.z)) {
      const int half_width = half_widths[row.offset];
      if (half_width < 0) continue;
      const std::uint32_t begin = row.starts[block.x - half_width];
      const std::uint32_t end = row.starts[block.x + half_width + 1];
      if (begin < end) scratch.ranges.push_back({begin, end});
    }
  }

  template <class HalfWidthOf>
  HalfWidths halfWidths(HalfWidthOf&& halfWidthOf) const {
    HalfWidths out;
    for (int z = -reach_; z <= reach_; ++z)
      for (int y = -reach_; y <= reach_; ++y) out.push_back(halfWidthOf(y, z));
    return out;
  }

  /// Blocks that may hold a point nearer than `length` to a voxel centre. Lengths share their
  /// widths by quarters of a voxel, rounded up: points too far are sorted out later.
  const HalfWidths& halfWidthsWithin(float length, Scratch& scratch) const {
    constexpr float kSteps = 4;
    const auto step = static_cast<std::size_t>(std::ceil(length * kSteps));
    if (scratch.half_widths.size() <= step) scratch.half_widths.resize(step + 1);
    HalfWidths& found = scratch.half_widths[step];
    if (!found.empty()) return found;
    const float longest = static_cast<float>(step) / kSteps;
    const float limit = longest * longest;
    found = halfWidths([&](int y, int z) {
      int x = -1;
      while (x < reach_ && gapSquared(x + 1) + gapSquared(y) + gapSquared(z) < limit) ++x;
      return x;
    });
    return found;
  }

  /// The block alone, or with the neighbours of its extended block.
  const HalfWidths& halfWidthsOfExtendedBlock(float entropy, Scratch& scratch) const {
    scratch.half_widths.resize(2);
    const bool alone = entropy <= kPureBlockEntropy;
    HalfWidths& found = scratch.half_widths[alone ? 0 : 1];
    if (!found.empty()) return found;
    found = halfWidths([&](int y, int z) {
      int x = -1;
      for (const detail::BlockOffset& d : neighbours_) {
        if (d.y == y && d.z == z && (!alone || d.kind() == 0)) x = std::max(x, d.x);
      }
      return x;
    });
    return found;
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
