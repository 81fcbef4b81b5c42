// SPDX-License-Identifier: BSD-3-Clause
#include "KernelMass.h"

#include <csom/core/Kernel.h>

namespace csom::detail {

namespace {

template <class KernelFunction>
inline __attribute__((always_inline)) void addMass(KernelFunction kernel, const LaneGroup& group,
                                                   const NearbyPoints& points,
                                                   const PreparedScan& scan, float length,
                                                   int number_of_classes, LaneSums& sums) {
  const float inverse_length = 1.0F / length;
  const bool hard = scan.scores.empty();
  for (const NearbyPoints::Point& p : points) {
    const Lanes dx = group.x - p.x;
    const Lanes dy = group.y - p.y;
    const Lanes dz = group.z - p.z;
    const Lanes t = squareRoot(dx * dx + dy * dy + dz * dz) * inverse_length;
    const Lanes mass = t < 1.0F ? kernel(t) : Lanes{};
    if (hard) {
      sums.add(scan.points[p.index].label, mass);
    } else {
      sums.add(scan.scores.data() +
                   static_cast<std::size_t>(p.index) * static_cast<std::size_t>(number_of_classes),
               mass);
    }
  }
}

CSOM_EVERY_PROCESSOR
void addSparse(const LaneGroup& group, const NearbyPoints& points, const PreparedScan& scan,
               float length, int number_of_classes, LaneSums& sums) {
  addMass(
      [](const Lanes& t) __attribute__((always_inline)) { return sparseKernel(t); }, group, points,
      scan, length, number_of_classes, sums);
}

CSOM_EVERY_PROCESSOR
void addLinear(const LaneGroup& group, const NearbyPoints& points, const PreparedScan& scan,
               float length, int number_of_classes, LaneSums& sums) {
  addMass(
      [](const Lanes& t) __attribute__((always_inline)) { return linearKernel(t); }, group, points,
      scan, length, number_of_classes, sums);
}

}  // namespace

void addKernelMass(Kernel kernel, const LaneGroup& group, const NearbyPoints& points,
                   const PreparedScan& scan, float length, int number_of_classes, LaneSums& sums) {
  if (kernel == Kernel::Sparse) {
    addSparse(group, points, scan, length, number_of_classes, sums);
  } else {
    addLinear(group, points, scan, length, number_of_classes, sums);
  }
}

}  // namespace csom::detail
