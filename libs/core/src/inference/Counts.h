// SPDX-License-Identifier: BSD-3-Clause
// Kernel mass, rounded once to the quantum.
#pragma once

#include <csom/core/DirichletVoxel.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "util/Lanes.h"

namespace csom::detail {

/// Sums of mass of the voxels of eight lanes.
using MassLanes = double __attribute__((vector_size(kLanes * sizeof(double))));
/// What structs of them must ask for, as the compiler asks for less where it compiles without AVX.
struct alignas(sizeof(MassLanes)) AlignedMassLanes {
  MassLanes lanes;
};
/// Counts of the voxels of eight lanes.
using CountLanes = std::array<std::uint32_t, kLanes>;

/// Added to a number of less than 2³², this leaves the nearest integer in the lowest bits: without
/// a branch, and for eight lanes at once where processors have no such conversion.
constexpr double kRoundingOffset = 4503599627370496.0;  // 2⁵²

/// `mass` is not negative.
inline std::uint32_t toCount(double mass) {
  const double quanta = std::min(mass / kCountQuantum, static_cast<double>(kMaxCount));
  const double offset = quanta + kRoundingOffset;
  std::uint64_t bits = 0;
  std::memcpy(&bits, &offset, sizeof bits);
  return static_cast<std::uint32_t>(bits);
}

/// The same for eight lanes.
CSOM_INLINE void toCounts(const MassLanes& mass, CountLanes& counts) {
  using Bits = std::uint64_t __attribute__((vector_size(sizeof(MassLanes))));
  constexpr double kMax = kMaxCount;
  const MassLanes quanta = mass * (1 / kCountQuantum);
  const MassLanes offset = (quanta < kMax ? quanta : MassLanes{} + kMax) + kRoundingOffset;
  const WordLanes rounded = __builtin_convertvector(reinterpret_cast<Bits>(offset), WordLanes);
  std::memcpy(counts.data(), &rounded, sizeof rounded);
}

}  // namespace csom::detail
