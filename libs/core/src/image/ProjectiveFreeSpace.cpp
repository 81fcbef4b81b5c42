// SPDX-License-Identifier: BSD-3-Clause
#include "image/ProjectiveFreeSpace.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "image/VoxelWords.h"
#include "inference/BoundedWords.h"
#include "util/Parallel.h"

namespace csom::detail {

namespace {

/// Half the edge of the cube that must be free, in voxels: a tenth is left on each side.
constexpr float kHalfEdge = 0.4F;

/// What a scan says of a voxel that it looks through as a whole [quanta]. Much more than of one
/// that it hits: whatever was there has left, however long it stood.
constexpr float kFreeWord = 16 * kFullWord;
/// Of one that it sees only in part, as at the border of the image: half of what a beam says.
/// Ground that the lowest beams hit but once, and lay partly in front of afterwards, must stay.
constexpr float kFreeWordInPart = 0.5F * kPartOfWord * kFullWord;

/// A cube of chunks: 2^level a side, at this position in units of it.
struct Node {
  int level;
  std::int32_t x, y, z;
};

class FreeSpaceSearch {
 public:
  FreeSpaceSearch(const ImageBeams& beams, const DepthCube& cube, const Options& options)
      : cube_(cube),
        base_(chunkOf(beams.base)),
        resolution_(static_cast<float>(options.resolution)) {
    constexpr float kVoxel = 1 << HalfStepPosition::kBits;
    sensor_ = {static_cast<float>(beams.sensor.x) / kVoxel,
               static_cast<float>(beams.sensor.y) / kVoxel,
               static_cast<float>(beams.sensor.z) / kVoxel};
    float reach = 0;
    for (std::size_t i = 0; i < beams.size(); ++i)
      reach = std::max({reach, std::abs(beams.x[i]), std::abs(beams.y[i]), std::abs(beams.z[i])});
    const float chunks = reach / resolution_ / kChunkSide + 2;
    while (static_cast<float>(1 << root_level_) < chunks) ++root_level_;
  }

  ScanIncrements run(int threads) {
    // Enough pieces for threads to share.
    std::vector<Node> nodes;
    const int level = std::max(0, root_level_ - 3);
    const std::int32_t half = 1 << (root_level_ - level);
    for (std::int32_t z = -half; z < half; ++z)
      for (std::int32_t y = -half; y < half; ++y)
        for (std::int32_t x = -half; x < half; ++x) nodes.push_back({level, x, y, z});
    ScanIncrements out;
    std::mutex mutex;
    parallelRanges(nodes.size(), threads, [&](std::size_t begin, std::size_t end) {
      ScanIncrements found;
      for (std::size_t i = begin; i < end; ++i) search(nodes[i], found);
      const std::lock_guard<std::mutex> lock(mutex);
      out.insert(out.end(), found.begin(), found.end());
    });
    return out;
  }

 private:
  /// Bounds along an axis of the cube of a voxel, relative to the sensor [m].
  float lower(std::int32_t voxel, std::size_t axis) const {
    return (static_cast<float>(voxel) + (0.5F - kHalfEdge) - sensor_[axis]) * resolution_;
  }
  float upper(std::int32_t voxel, std::size_t axis) const {
    return (static_cast<float>(voxel) + (0.5F + kHalfEdge) - sensor_[axis]) * resolution_;
  }
  /// The box around the cubes of the voxels of a node.
  SpaceBox boxOf(const Node& node) const {
    const std::int32_t edge = kChunkSide << node.level;
    SpaceBox box{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int32_t first = (axis == 0 ? node.x : axis == 1 ? node.y : node.z) * edge;
      box.min[axis] = lower(first, axis);
      box.max[axis] = upper(first + edge - 1, axis);
    }
    return box;
  }
  ChunkBoxes boxesOf(const Node& chunk) const {
    ChunkBoxes boxes{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int32_t first = (axis == 0 ? chunk.x : axis == 1 ? chunk.y : chunk.z) * kChunkSide;
      for (std::int32_t i = 0; i < kChunkSide; ++i) {
        boxes.min[axis][static_cast<std::size_t>(i)] = lower(first + i, axis);
        boxes.max[axis][static_cast<std::size_t>(i)] = upper(first + i, axis);
      }
    }
    return boxes;
  }

  void search(const Node& node, ScanIncrements& out) const {
    const CubeWindows windows = cube_.grid().windowsOf(boxOf(node));
    if (std::all_of(windows.begin(), windows.end(),
                    [&](const CubeWindow& window) { return isAllBehind(window); }))
      return;
    if (node.level == 0) {
      searchChunk(node, windows, out);
      return;
    }
    for (std::int32_t z = 0; z < 2; ++z)
      for (std::int32_t y = 0; y < 2; ++y)
        for (std::int32_t x = 0; x < 2; ++x)
          search({node.level - 1, 2 * node.x + x, 2 * node.y + y, 2 * node.z + z}, out);
  }

  /// With the pixels beside the window that may be looked at for a voxel.
  bool isAllBehind(const CubeWindow& window) const {
    const int last = cube_.grid().side() - 1;
    const int beside = window.nearest > 0
                           ? cube_.grid().mostBeside(2 * kHalfEdge * resolution_, window.nearest)
                           : last;
    CubeWindow larger = window;
    larger.first_u = std::max(window.first_u - beside, 0);
    larger.last_u = std::min(window.last_u + beside, last);
    larger.first_v = std::max(window.first_v - beside, 0);
    larger.last_v = std::min(window.last_v + beside, last);
    return cube_.isAllBehind(larger);
  }

  void searchChunk(const Node& node, const CubeWindows& windows, ScanIncrements& out) const {
    VoxelsInFront voxels;
    voxels.in_front.fill(~std::uint64_t{0});
    voxels.all_seen.fill(~std::uint64_t{0});
    const bool one_face = windows.size() == 1;
    const ChunkBoxes boxes = boxesOf(node);
    for (const CubeWindow& window : windows)
      cube_.keepInFront(boxes, window.face, one_face, voxels);
    const bool any = std::any_of(voxels.in_front.begin(), voxels.in_front.end(),
                                 [](std::uint64_t word) { return word != 0; });
    if (!any) return;
    const float covered = coveredAt(windows);
    const auto count = [covered](float word) {
      return static_cast<std::uint32_t>(word * covered * covered + 0.5F);
    };
    const std::uint32_t count_in_part = count(kFreeWordInPart);
    if (count_in_part == 0) return;  // beams are too far apart to say anything
    ChunkIncrements& chunk = out.emplace_back();
    chunk.chunk = {base_.x + node.x, base_.y + node.y, base_.z + node.z};
    chunk.free.count = count(kFreeWord);
    for (std::size_t word = 0; word < voxels.in_front.size(); ++word) {
      chunk.free.voxels[word] = voxels.in_front[word] & voxels.all_seen[word];
      for (std::uint64_t bits = voxels.in_front[word] & ~voxels.all_seen[word]; bits != 0;
           bits &= bits - 1) {
        const auto voxel =
            static_cast<std::uint16_t>(64 * word + static_cast<unsigned>(__builtin_ctzll(bits)));
        chunk.increments.push_back({voxel, kFreeClass, count_in_part});
      }
    }
  }

  /// The share of a voxel's face that beams cover, where they are farther apart than it is wide.
  float coveredAt(const CubeWindows& windows) const {
    float beams = 0;
    for (const CubeWindow& window : windows)
      beams =
          std::max(beams, cube_.spacing(window.face, 0.5F * (window.nearest + window.farthest)));
    return beams <= resolution_ ? 1 : resolution_ / beams;
  }

  const DepthCube& cube_;
  ChunkIndex base_;  ///< from which nodes are counted
  float resolution_;
  std::array<float, 3> sensor_{};  ///< from the base [voxels]
  int root_level_ = 0;
};

}  // namespace

ScanIncrements findFreeSpace(const ImageBeams& beams, const DepthCube& cube,
                             const Options& options) {
  return FreeSpaceSearch(beams, cube, options).run(options.threads);
}

}  // namespace csom::detail
