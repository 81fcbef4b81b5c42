// SPDX-License-Identifier: BSD-3-Clause
#include "inference/KernelMass.h"

#include "inference/KernelMassLoops.h"

namespace csom::detail {

namespace {

CSOM_EVERY_PROCESSOR
void addMass(Kernel kernel, const PointColumns& points, const std::vector<std::uint32_t>& selected,
             const std::vector<float>& scores, const LaneGroup& group, const BlockPlace& block,
             float inverse_length, LaneSums& sums) {
  addMassOfPoints(
      kernel, [=](std::uint32_t) __attribute__((always_inline)) { return inverse_length; }, points,
      selected, scores, group, block, sums);
}

CSOM_EVERY_PROCESSOR
void countMass(const LaneSums& sums, double scale, CountLanes* counts) {
  for (const ClassId k : sums.classes()) toCounts(sums.mass(k) * scale, *counts++);
}

CSOM_EVERY_PROCESSOR
std::size_t select(const PointColumns& points, const std::vector<PointRange>& ranges,
                   const BlockPlace& block, float length, std::uint32_t* selected) {
  const Lanes limit = Lanes{} + length * kUnits;
  return selectPoints(
      points, ranges, block, [&](std::uint32_t) __attribute__((always_inline)) { return limit; },
      selected);
}

}  // namespace

std::vector<LaneGroup> laneGroups(const BlockLayout& layout) {
  const int side = layout.side();
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

void sumKernelMass(Kernel kernel, const PointColumns& points,
                   const std::vector<std::uint32_t>& selected, const std::vector<float>& scores,
                   const LaneGroup& group, const BlockPlace& block, float length, double scale,
                   LaneSums& sums, std::vector<CountLanes>& counts) {
  sums.reset();
  addMass(kernel, points, selected, scores, group, block, 1.0F / length / kUnits, sums);
  sums.finish();
  counts.resize(sums.classes().size());
  countMass(sums, scale, counts.data());
}

}  // namespace csom::detail
