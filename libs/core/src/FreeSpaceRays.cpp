// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/DirichletVoxel.h>
#include <csom/core/FreeSpaceRays.h>

#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "Lanes.h"
#include "Parallel.h"
#include "Parts.h"
#include "VoxelBits.h"
#include "VoxelRuns.h"

namespace csom {

namespace {

using detail::VoxelBits;
using detail::VoxelCode;

/// What one axis contributes to a beam: where it crosses the planes between voxels, and the axis'
/// part of the voxel's code before the first crossing and after each.
struct AxisCrossings {
  std::vector<double> at;  ///< fractions of the beam, ascending, then infinity
  std::vector<VoxelCode> code;
};

/// The walk of detail::traverseVoxels() for beams that are walked to their end: the same crossings,
/// in the same order, but all divisions of an axis at once and no branch that depends on which
/// plane comes first.
class BeamMarker {
 public:
  BeamMarker(const Grid& grid, const Eigen::Vector3d& origin, const detail::VoxelCoder& coder)
      : grid_(grid), origin_(origin), coder_(coder) {}

  void mark(const Eigen::Vector3d& target, VoxelBits& crossed) {
    const Eigen::Vector3d displacement = target - origin_;
    std::size_t steps = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int32_t first = grid_.indexOf(origin_[axis]);
      const std::int32_t last = grid_.indexOf(target[axis]);
      const auto size = static_cast<std::size_t>(std::abs(last - first));
      AxisCrossings& crossings = axes_[static_cast<std::size_t>(axis)];
      if (crossings.at.size() < size + 1) {
        crossings.at.resize(2 * size + 1);
        crossings.code.resize(2 * size + 1);
      }
      cross(grid_.resolution(), origin_[axis], displacement[axis], first, last,
            crossings.at.data());
      crossings.at[size] = std::numeric_limits<double>::infinity();
      const std::int32_t step = last > first ? 1 : -1;
      for (std::size_t i = 0; i <= size; ++i)
        crossings.code[i] = coder_.code(axis, first + step * static_cast<std::int32_t>(i));
      steps += size;
    }
    walk(steps, crossed);
  }

 private:
  /// Where the planes between the voxels `first` and `last` of an axis are crossed.
  CSOM_EVERY_PROCESSOR
  static void cross(double resolution, double origin, double displacement, std::int32_t first,
                    std::int32_t last, double* at) {
    const std::int32_t step = last > first ? 1 : -1;
    const std::int32_t plane = last > first ? first + 1 : first;
    const std::int32_t size = (last - first) * step;
    for (std::int32_t i = 0; i < size; ++i)
      at[i] = (resolution * (plane + step * i) - origin) / displacement;
  }

  void walk(std::size_t steps, VoxelBits& crossed) const {
    const auto& [x, y, z] = axes_;
    std::size_t in_x = 0;
    std::size_t in_y = 0;
    std::size_t in_z = 0;
    VoxelCode chunk = ~VoxelCode{0};
    VoxelBits::Bits* bits = nullptr;
    for (std::size_t step = 0;; ++step) {
      const VoxelCode voxel = x.code[in_x] | y.code[in_y] | z.code[in_z];
      if (detail::chunkOfCode(voxel) != chunk) {
        chunk = detail::chunkOfCode(voxel);
        bits = &crossed.of(chunk);
      }
      VoxelBits::set(*bits, voxel);
      if (step == steps) break;
      const double next_x = x.at[in_x];
      const double next_y = y.at[in_y];
      const double next_z = z.at[in_z];
      const bool by_z = (next_x <= next_y ? next_x : next_y) > next_z;
      const bool by_x = !by_z & (next_x <= next_y);
      in_x += by_x ? 1 : 0;
      in_y += by_x | by_z ? 0 : 1;
      in_z += by_z ? 1 : 0;
    }
  }

  const Grid& grid_;
  const Eigen::Vector3d origin_;
  const detail::VoxelCoder& coder_;
  std::array<AxisCrossings, 3> axes_;
};

VoxelBits crossedVoxels(const PreparedScan& scan, const Grid& grid, const detail::VoxelCoder& coder,
                        int threads) {
  const std::vector<Eigen::Vector3d>& ends = scan.beam_ends;
  const std::size_t count = detail::partsFor(ends.size(), threads);
  std::vector<VoxelBits> parts(count);
  detail::parallelRanges(count, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = begin; part < end; ++part) {
      BeamMarker marker(grid, scan.origin, coder);
      const std::size_t last = detail::partBegin(ends.size(), part + 1, count);
      for (std::size_t i = detail::partBegin(ends.size(), part, count); i < last; ++i)
        marker.mark(ends[i], parts[part]);
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

ScanIncrements castFreeSpace(const PreparedScan& scan, const Options& options, ScanReport& report) {
  if (scan.beam_ends.empty()) return {};
  ScanIncrements out;
  const Grid grid(options.resolution);
  const detail::VoxelCoder coder(grid.voxelAt(scan.origin));
  const std::uint32_t count = detail::toCount(options.free_weight);
  crossedVoxels(scan, grid, coder, options.threads)
      .forEachChunk([&](VoxelCode chunk, const VoxelBits::Bits& bits) {
        std::size_t voxels = 0;
        for (const std::uint64_t word : bits)
          voxels += static_cast<std::size_t>(__builtin_popcountll(word));
        if (voxels == 0) return;
        report.free_voxels += voxels;
        std::vector<CountIncrement> increments(voxels);
        auto next = increments.begin();
        for (std::size_t word = 0; word < bits.size(); ++word) {
          for (std::uint64_t left = bits[word]; left != 0; left &= left - 1) {
            const auto voxel = static_cast<std::uint16_t>(
                word * 64 + static_cast<std::size_t>(__builtin_ctzll(left)));
            *next++ = {voxel, kFreeClass, count};
          }
        }
        out.push_back({coder.chunk(chunk), std::move(increments)});
      });
  return out;
}

}  // namespace csom
