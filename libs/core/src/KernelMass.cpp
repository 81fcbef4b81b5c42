// SPDX-License-Identifier: BSD-3-Clause
#include "KernelMass.h"

#include <csom/core/Kernel.h>

#include <cstring>

namespace csom::detail {

namespace {

inline Lanes load(const float* values) {
  Lanes lanes;
  std::memcpy(&lanes, values, sizeof lanes);
  return lanes;
}

/// Distance along one axis from the interval center ± half, 0 inside.
inline Lanes distanceBeyond(const Lanes& coordinate, float center, float half) {
  const Lanes offset = coordinate - center;
  const Lanes beyond = (offset > 0.0F ? offset : -offset) - half;
  return beyond > 0.0F ? beyond : Lanes{};
}

template <class KernelFunction>
inline __attribute__((always_inline)) void addMass(KernelFunction kernel, const BlockWindow& window,
                                                   const std::vector<std::uint32_t>& selected,
                                                   const PreparedScan& scan, const LaneGroup& group,
                                                   const BlockPlace& block, float length,
                                                   LaneSums& sums) {
  const float inverse_length = 1.0F / length;
  const bool hard = scan.scores.empty();
  const Lanes x = group.x + block.x;
  const Lanes y = group.y + block.y;
  const Lanes z = group.z + block.z;
  for (const std::uint32_t i : selected) {
    const Lanes dx = x - window.x()[i];
    const Lanes dy = y - window.y()[i];
    const Lanes dz = z - window.z()[i];
    const Lanes t = squareRoot(dx * dx + dy * dy + dz * dz) * inverse_length;
    const Lanes mass = t < 1.0F ? kernel(t) : Lanes{};
    const std::uint32_t point = window.point()[i];
    if (hard) {
      sums.add(scan.points[point].label, mass);
    } else {
      sums.add(scan.scores.data() + static_cast<std::size_t>(point) * sums.numberOfClasses(), mass);
    }
  }
}

CSOM_EVERY_PROCESSOR
void addSparse(const BlockWindow& window, const std::vector<std::uint32_t>& selected,
               const PreparedScan& scan, const LaneGroup& group, const BlockPlace& block,
               float length, LaneSums& sums) {
  addMass(
      [](const Lanes& t) __attribute__((always_inline)) { return sparseKernel(t); }, window,
      selected, scan, group, block, length, sums);
}

CSOM_EVERY_PROCESSOR
void addLinear(const BlockWindow& window, const std::vector<std::uint32_t>& selected,
               const PreparedScan& scan, const LaneGroup& group, const BlockPlace& block,
               float length, LaneSums& sums) {
  addMass(
      [](const Lanes& t) __attribute__((always_inline)) { return linearKernel(t); }, window,
      selected, scan, group, block, length, sums);
}

CSOM_EVERY_PROCESSOR
std::size_t select(const BlockWindow& window, const std::vector<PointRange>& ranges,
                   const BlockPlace& block, float length, std::uint32_t* selected) {
  const float middle = block.edge / 2;
  const float half = middle - 0.5F;  // from the middle to the outermost voxel centres
  const float limit = length * length;
  std::size_t size = 0;
  for (const PointRange& range : ranges) {
    for (std::uint32_t first = range.first; first < range.last; first += kLanes) {
      const Lanes dx = distanceBeyond(load(window.x() + first), block.x + middle, half);
      const Lanes dy = distanceBeyond(load(window.y() + first), block.y + middle, half);
      const Lanes dz = distanceBeyond(load(window.z() + first), block.z + middle, half);
      const Lanes squared = dx * dx + dy * dy + dz * dz;
      const auto count = std::min<std::uint32_t>(kLanes, range.last - first);
      for (std::uint32_t lane = 0; lane < count; ++lane) {
        selected[size] = first + lane;
        size += squared[lane] < limit ? 1 : 0;
      }
    }
  }
  return size;
}

}  // namespace

void selectNearby(const BlockWindow& window, const std::vector<PointRange>& ranges,
                  const BlockPlace& block, float length, std::vector<std::uint32_t>& selected) {
  std::size_t candidates = 0;
  for (const PointRange& range : ranges) candidates += range.last - range.first;
  selected.resize(candidates);
  selected.resize(select(window, ranges, block, length, selected.data()));
}

void addKernelMass(Kernel kernel, const BlockWindow& window,
                   const std::vector<std::uint32_t>& selected, const PreparedScan& scan,
                   const LaneGroup& group, const BlockPlace& block, float length, LaneSums& sums) {
  if (kernel == Kernel::Sparse) {
    addSparse(window, selected, scan, group, block, length, sums);
  } else {
    addLinear(window, selected, scan, group, block, length, sums);
  }
}

}  // namespace csom::detail
