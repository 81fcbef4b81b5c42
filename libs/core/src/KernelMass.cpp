// SPDX-License-Identifier: BSD-3-Clause
#include "KernelMass.h"

#include <csom/core/Kernel.h>

#include <algorithm>

#include "FixedPointLanes.h"

namespace csom::detail {

namespace {

template <class KernelFunction>
CSOM_INLINE void addMass(KernelFunction kernel, const PointColumns& points,
                         const std::vector<std::uint32_t>& selected,
                         const std::vector<float>& scores, const LaneGroup& group,
                         const BlockPlace& block, float length, LaneSums& sums) {
  const float inverse_length = 1.0F / length / kUnits;
  const WordLanes x = group.x + block.x;
  const WordLanes y = group.y + block.y;
  const WordLanes z = group.z + block.z;
  const FixedPoint* const px = points.x.data();
  const FixedPoint* const py = points.y.data();
  const FixedPoint* const pz = points.z.data();
  alignas(kLaneAlignment) std::array<Lanes, LaneSums::kCarryInterval> masses;
  for (std::size_t first = 0; first < selected.size(); first += masses.size()) {
    const std::size_t size = std::min(masses.size(), selected.size() - first);
    const std::uint32_t* const batch = selected.data() + first;
    for (std::size_t i = 0; i < size; ++i) {
      const std::uint32_t p = batch[i];
      const Lanes dx = toFloat(x - px[p]);
      const Lanes dy = toFloat(y - py[p]);
      const Lanes dz = toFloat(z - pz[p]);
      const Lanes t = squareRoot(dx * dx + dy * dy + dz * dz) * inverse_length;
      masses[i] = t < 1.0F ? kernel(t) : Lanes{};
    }
    if (scores.empty()) {
      sums.add(points.label.data(), batch, masses.data(), size);
    } else {
      sums.add(scores.data(), batch, masses.data(), size);
    }
    sums.carry();
  }
}

CSOM_EVERY_PROCESSOR
void addSparse(const PointColumns& points, const std::vector<std::uint32_t>& selected,
               const std::vector<float>& scores, const LaneGroup& group, const BlockPlace& block,
               float length, LaneSums& sums) {
  addMass(
      [](const Lanes& t) __attribute__((always_inline)) { return sparseKernel(t); }, points,
      selected, scores, group, block, length, sums);
}

CSOM_EVERY_PROCESSOR
void addLinear(const PointColumns& points, const std::vector<std::uint32_t>& selected,
               const std::vector<float>& scores, const LaneGroup& group, const BlockPlace& block,
               float length, LaneSums& sums) {
  addMass(
      [](const Lanes& t) __attribute__((always_inline)) { return linearKernel(t); }, points,
      selected, scores, group, block, length, sums);
}

CSOM_EVERY_PROCESSOR
std::size_t select(const PointColumns& points, const std::vector<PointRange>& ranges,
                   const BlockPlace& block, float length, std::uint32_t* selected) {
  const FixedPoint middle = block.edge / 2;
  const FixedPoint half = middle - kFixedPointVoxel / 2;  // to the outermost voxel centres
  const float limit = length * length * (kUnits * kUnits);
  std::size_t size = 0;
  for (const PointRange& range : ranges) {
    for (std::uint32_t first = range.first; first < range.last; first += kLanes) {
      const Lanes dx = distanceBeyond(load(points.x.data() + first), block.x + middle, half);
      const Lanes dy = distanceBeyond(load(points.y.data() + first), block.y + middle, half);
      const Lanes dz = distanceBeyond(load(points.z.data() + first), block.z + middle, half);
      const Lanes squared = dx * dx + dy * dy + dz * dz;
      const auto count = std::min<std::uint32_t>(kLanes, range.last - first);
      const IntLanes near = squared < limit;
      for (std::uint32_t lane = 0; lane < count; ++lane) {
        selected[size] = first + lane;
        size += near[lane] != 0 ? 1 : 0;
      }
    }
  }
  return size;
}

}  // namespace

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
            return fixedPoint(voxel) + kFixedPointVoxel / 2;
          };
          group.x[l] = centre(group.voxel[l].x);
          group.y[l] = centre(group.voxel[l].y);
          group.z[l] = centre(group.voxel[l].z);
        }
        groups.push_back(group);
      }
  return groups;
}

void selectNearby(const PointColumns& points, const std::vector<PointRange>& ranges,
                  const BlockPlace& block, float length, std::vector<std::uint32_t>& selected) {
  std::size_t candidates = 0;
  for (const PointRange& range : ranges) candidates += range.last - range.first;
  selected.resize(candidates);
  selected.resize(select(points, ranges, block, length, selected.data()));
}

void addKernelMass(Kernel kernel, const PointColumns& points,
                   const std::vector<std::uint32_t>& selected, const std::vector<float>& scores,
                   const LaneGroup& group, const BlockPlace& block, float length, LaneSums& sums) {
  if (kernel == Kernel::Sparse) {
    addSparse(points, selected, scores, group, block, length, sums);
  } else {
    addLinear(points, selected, scores, group, block, length, sums);
  }
}

}  // namespace csom::detail
