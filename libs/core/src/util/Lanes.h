// SPDX-License-Identifier: BSD-3-Clause
// Eight voxels side by side, the width of the hot loop.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "util/Sanitizers.h"

namespace csom::detail {

/// SIMD lanes are voxels: each lane adds its points one after the other, so that a sum does not
/// depend on the width of the processor's vectors. The compiler turns this type into one AVX
/// register or two SSE registers.
constexpr std::size_t kLanes = 8;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));
using IntLanes = std::int32_t __attribute__((vector_size(kLanes * sizeof(std::int32_t))));
using WordLanes = std::uint32_t __attribute__((vector_size(kLanes * sizeof(std::uint32_t))));
/// What structs of lanes must ask for: the compiler takes less where it compiles without AVX.
constexpr std::size_t kLaneAlignment = sizeof(Lanes);

// Functions marked with it are compiled for AVX2 too, and the processor chooses when the program
// starts: one binary runs everywhere. No fused multiply-add in either, so the bits are the same.
// Sanitizers intercept calls before such a choice can be made. Where instructions are counted they
// must be the same on every processor: CSOM_NO_PROCESSOR_DISPATCH. Clang refuses vectors as results
// in such functions, inlined or not: its code is that of any processor.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) &&     \
    !defined(CSOM_ADDRESS_SANITIZED) && !defined(CSOM_THREAD_SANITIZED) && \
    !defined(CSOM_NO_PROCESSOR_DISPATCH)
#define CSOM_EVERY_PROCESSOR __attribute__((target_clones("avx2", "default")))
#else
#define CSOM_EVERY_PROCESSOR
#endif
// For classes with such functions: a program that has csom::core inside and loads a library that
// has it inside as well must not mix the choices of the two.
#if defined(__GNUC__)
#define CSOM_OF_ONE_BINARY __attribute__((visibility("hidden")))
#else
#define CSOM_OF_ONE_BINARY
#endif
// What such a function calls must become part of it, to be compiled for the same processor: also
// where nothing is optimised, as vectors are passed in other registers there.
#define CSOM_INLINE inline __attribute__((always_inline))

// By reference, which is the same everywhere, so that the compiler may choose where to inline it.
inline void takeSquareRoots(const Lanes& v, Lanes& roots) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) roots[lane] = std::sqrt(v[lane]);
}
CSOM_INLINE Lanes squareRoot(const Lanes& v) {
  Lanes roots;
  takeSquareRoots(v, roots);
  return roots;
}

}  // namespace csom::detail
