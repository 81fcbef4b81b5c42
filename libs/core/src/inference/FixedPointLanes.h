// SPDX-License-Identifier: BSD-3-Clause
// Coordinates of training points, eight at a time.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include "inference/PointColumns.h"
#include "util/Lanes.h"

namespace csom::detail {

/// Lengths in units of FixedPoint are those in voxels times this power of two: squares, roots and
/// quotients of floats come out with the same digits in either.
constexpr float kUnits = kFixedPointVoxel;

CSOM_INLINE Lanes toFloat(const WordLanes& difference) {
  return __builtin_convertvector(reinterpret_cast<const IntLanes&>(difference), Lanes);
}

CSOM_INLINE WordLanes load(const FixedPoint* values) {
  WordLanes lanes;
  std::memcpy(&lanes, values, sizeof lanes);
  return lanes;
}

CSOM_INLINE Lanes load(const float* values) {
  Lanes lanes;
  std::memcpy(&lanes, values, sizeof lanes);
  return lanes;
}

/// True if no lane of a condition holds.
CSOM_INLINE bool isNone(const IntLanes& condition) {
  std::array<std::uint64_t, sizeof(IntLanes) / sizeof(std::uint64_t)> words;
  std::memcpy(words.data(), &condition, sizeof words);
  return (words[0] | words[1] | words[2] | words[3]) == 0;
}

/// Distance along one axis from the interval center ± half, 0 inside.
CSOM_INLINE Lanes distanceBeyond(const WordLanes& coordinate, FixedPoint center, FixedPoint half) {
  const WordLanes difference = coordinate - center;
  const auto offset = reinterpret_cast<const IntLanes&>(difference);
  const IntLanes beyond = (offset > 0 ? offset : -offset) - static_cast<std::int32_t>(half);
  return __builtin_convertvector(beyond > 0 ? beyond : IntLanes{}, Lanes);
}

}  // namespace csom::detail
