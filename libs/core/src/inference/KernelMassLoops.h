// SPDX-License-Identifier: BSD-3-Clause
// The innermost loops, for kernels of one length or of a length a point. What calls them chooses
// the processor (CSOM_EVERY_PROCESSOR); they become part of it.
#pragma once

#include <csom/core/Kernel.h>
#include <csom/core/Options.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "inference/FixedPointLanes.h"
#include "inference/KernelMass.h"
#include "inference/LaneSums.h"

namespace csom::detail {

/// Lists, in order, the points of the ranges that are nearer to the box of the block's voxel
/// centres than limit(first), the lengths of eight points from `first` on, in kUnits. Returns how
/// many. `Points` has coordinates x, y, z as vectors of FixedPoint, padded by a whole vector.
template <class Points, class Ranges, class Limit>
CSOM_INLINE std::size_t selectPoints(const Points& points, const Ranges& ranges,
                                     const BlockPlace& block, Limit limit,
                                     std::uint32_t* selected) {
  const FixedPoint middle = block.edge / 2;
  const FixedPoint half = middle - kFixedPointVoxel / 2;  // to the outermost voxel centres
  std::size_t size = 0;
  for (const PointRange& range : ranges) {
    for (std::uint32_t first = range.first; first < range.last; first += kLanes) {
      const Lanes dx = distanceBeyond(load(points.x.data() + first), block.x + middle, half);
      const Lanes dy = distanceBeyond(load(points.y.data() + first), block.y + middle, half);
      const Lanes dz = distanceBeyond(load(points.z.data() + first), block.z + middle, half);
      const Lanes length = limit(first);
      const IntLanes near = dx * dx + dy * dy + dz * dz < length * length;
      const auto count = std::min<std::uint32_t>(kLanes, range.last - first);
      for (std::uint32_t lane = 0; lane < count; ++lane) {
        selected[size] = first + lane;
        size += near[lane] != 0 ? 1 : 0;
      }
    }
  }
  return size;
}

/// Adds the kernel mass of the selected points to the voxels of a group of a block, in their order,
/// with their labels or (if there are any) their scores. inverseLength(p): 1/L of a point, in
/// 1/kUnits.
template <class KernelFunction, class InverseLength, class Points>
CSOM_INLINE void addMassByKernel(KernelFunction kernel, InverseLength inverseLength,
                                 const Points& points, const std::vector<std::uint32_t>& selected,
                                 const std::vector<float>& scores, const LaneGroup& group,
                                 const BlockPlace& block, LaneSums& sums) {
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
      const Lanes t = squareRoot(dx * dx + dy * dy + dz * dz) * inverseLength(p);
      masses[i] = kernel(t);
    }
    if (scores.empty()) {
      sums.add(points.label.data(), batch, masses.data(), size);
    } else {
      sums.add(scores.data(), batch, masses.data(), size);
    }
    sums.carry();
  }
}

/// The same, with the kernel chosen outside of the loop.
template <class InverseLength, class Points>
CSOM_INLINE void addMassOfPoints(Kernel kernel, InverseLength inverseLength, const Points& points,
                                 const std::vector<std::uint32_t>& selected,
                                 const std::vector<float>& scores, const LaneGroup& group,
                                 const BlockPlace& block, LaneSums& sums) {
  if (kernel == Kernel::Sparse)
    addMassByKernel(
        [](const Lanes& t) __attribute__((always_inline)) { return sparseKernel(t); },
        inverseLength, points, selected, scores, group, block, sums);
  else
    addMassByKernel(
        [](const Lanes& t) __attribute__((always_inline)) { return linearKernel(t); },
        inverseLength, points, selected, scores, group, block, sums);
}

}  // namespace csom::detail
