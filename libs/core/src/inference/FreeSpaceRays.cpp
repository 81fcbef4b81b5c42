// SPDX-License-Identifier: BSD-3-Clause
#include "inference/FreeSpaceRays.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "inference/Counts.h"
#include "inference/VoxelBits.h"
#include "util/Lanes.h"
#include "util/Parallel.h"
#include "util/Parts.h"

namespace csom::detail {

namespace {

/// Where a beam crosses a plane between voxels, and what the axis of the plane contributes to the
/// code of the voxel before it.
struct Crossing {
  double at;  ///< fraction of the beam; infinity behind the last plane
  VoxelCode code;
};

/// A place on a beam: the next crossing of each axis.
struct BeamCursor {
  const Crossing* x;
  const Crossing* y;
  const Crossing* z;

  VoxelCode voxel() const { return x->code + y->code + z->code; }
  /// Goes on to the next voxel, without a branch that depends on which plane comes first.
  void step() {
    const bool by_z = (x->at <= y->at ? x->at : y->at) > z->at;
    const bool by_x = !by_z & (x->at <= y->at);
    x += by_x ? 1 : 0;
    y += (by_x | by_z) ? 0 : 1;
    z += by_z ? 1 : 0;
  }
};

/// The walk of detail::traverseVoxels() for beams that are walked to their end: the same crossings,
/// in the same order, but all divisions of an axis at once.
class Beam {
 public:
  void aim(const Grid& grid, const VoxelCoder& coder, const Eigen::Vector3d& origin,
           const Eigen::Vector3d& target) {
    const Eigen::Vector3d displacement = target - origin;
    steps_ = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int32_t first = grid.indexOf(origin[axis]);
      const std::int32_t last = grid.indexOf(target[axis]);
      const auto size = static_cast<std::size_t>(std::abs(last - first));
      std::vector<Crossing>& crossings = axes_[static_cast<std::size_t>(axis)];
      if (crossings.size() < size + 1) crossings.resize(2 * size + 1);
      cross(grid.resolution(), origin[axis], displacement[axis], first, last, crossings.data());
      crossings[size].at = std::numeric_limits<double>::infinity();
      const std::int32_t step = last > first ? 1 : -1;
      for (std::size_t i = 0; i <= size; ++i)
        crossings[i].code = coder.code(axis, first + step * static_cast<std::int32_t>(i));
      steps_ += size;
    }
  }

  BeamCursor start() const { return {axes_[0].data(), axes_[1].data(), axes_[2].data()}; }
  /// Crossings from the start to the end.
  std::size_t steps() const { return steps_; }

 private:
  /// Where the planes between the voxels `first` and `last` of an axis are crossed.
  CSOM_EVERY_PROCESSOR
  static void cross(double resolution, double origin, double displacement, std::int32_t first,
                    std::int32_t last, Crossing* crossings) {
    const std::int32_t step = last > first ? 1 : -1;
    const std::int32_t plane = last > first ? first + 1 : first;
    const std::int32_t size = (last - first) * step;
    for (std::int32_t i = 0; i < size; ++i)
      crossings[i].at = (resolution * (plane + step * i) - origin) / displacement;
  }

  std::array<std::vector<Crossing>, 3> axes_;
  std::size_t steps_ = 0;
};

/// Marks the voxels of both beams, side by side: each step of a beam waits for the one before it,
/// those of two beams do not wait for each other.
void markVoxels(const Beam& a, const Beam& b, VoxelBits& crossed) {
  BeamCursor on_a = a.start();
  BeamCursor on_b = b.start();
  const std::size_t together = std::min(a.steps(), b.steps());
  for (std::size_t step = 0; step < together; ++step) {
    crossed.insert(on_a.voxel());
    crossed.insert(on_b.voxel());
    on_a.step();
    on_b.step();
  }
  const auto finish = [&](BeamCursor on, std::size_t steps) {
    for (std::size_t step = together; step < steps; ++step, on.step()) crossed.insert(on.voxel());
    crossed.insert(on.voxel());
  };
  finish(on_a, a.steps());
  finish(on_b, b.steps());
}

VoxelBox computeBox(const PreparedScan& scan, const Grid& grid) {
  Eigen::Vector3d min = scan.origin;
  Eigen::Vector3d max = scan.origin;
  for (const Eigen::Vector3d& end : scan.beam_ends) {
    min = min.cwiseMin(end);
    max = max.cwiseMax(end);
  }
  VoxelBox box{grid.voxelAt(min), grid.voxelAt(max)};
  for (const VoxelIndex& v : scan.hit_voxels) {
    box.min = {std::min(box.min.x, v.x), std::min(box.min.y, v.y), std::min(box.min.z, v.z)};
    box.max = {std::max(box.max.x, v.x), std::max(box.max.y, v.y), std::max(box.max.z, v.z)};
  }
  return box;
}

VoxelBits crossedVoxels(const PreparedScan& scan, const Grid& grid, const VoxelCoder& coder,
                        int threads) {
  const std::vector<Eigen::Vector3d>& ends = scan.beam_ends;
  const std::size_t count = partsFor(ends.size(), threads);
  std::vector<VoxelBits> parts(count, VoxelBits(coder.chunkCount()));
  parallelRanges(count, threads, [&](std::size_t begin, std::size_t end) {
    Beam a;
    Beam b;
    for (std::size_t part = begin; part < end; ++part) {
      const std::size_t last = partBegin(ends.size(), part + 1, count);
      for (std::size_t i = partBegin(ends.size(), part, count); i < last; i += 2) {
        a.aim(grid, coder, scan.origin, ends[i]);
        b.aim(grid, coder, scan.origin, ends[std::min(i + 1, last - 1)]);
        markVoxels(a, b, parts[part]);
      }
    }
  });
  VoxelBits crossed = std::move(parts.front());
  // Unions commute: however the beams are divided, the set is the same.
  for (std::size_t part = 1; part < count; ++part) crossed.insert(parts[part]);
  for (const Eigen::Vector3d& end : ends) crossed.erase(coder.code(grid.voxelAt(end)));
  for (const VoxelIndex& voxel : scan.hit_voxels) crossed.erase(coder.code(voxel));
  return crossed;
}

}  // namespace

ScanIncrements castFreeSpace(const PreparedScan& scan, const Options& options, std::uint32_t count,
                             ScanReport& report) {
  if (scan.beam_ends.empty()) return {};
  ScanIncrements out;
  const Grid grid(options.resolution);
  const VoxelCoder coder(computeBox(scan, grid));
  crossedVoxels(scan, grid, coder, options.threads)
      .forEachChunk([&](VoxelCode chunk, const VoxelBits::Bits& bits) {
        std::size_t voxels = 0;
        for (const std::uint64_t word : bits)
          voxels += static_cast<std::size_t>(__builtin_popcountll(word));
        if (voxels == 0) return;
        report.free_voxels += voxels;
        out.push_back({coder.chunk(chunk), {}, {bits, count}});
      });
  return out;
}

}  // namespace csom::detail
