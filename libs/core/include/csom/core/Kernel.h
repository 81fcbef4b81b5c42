// SPDX-License-Identifier: BSD-3-Clause
// The kernels of eq. (19), as functions of the relative distance t = d/L.
#pragma once

#include <array>
#include <cstddef>

namespace csom {

/// The sparse kernel, (2+cos 2πt)/3·(1−t) + sin(2πt)/(2π) for t in [0, 1], as a polynomial of
/// degree 12 in 2t−1 (Chebyshev interpolation, within 2e-7 of the closed form). A polynomial,
/// because sums and products give the same bits on every processor and in every SIMD lane; sines do
/// not.
/// `Float` is float or a SIMD vector of floats.
template <class Float>
inline Float sparseKernel(const Float& t) {
  constexpr std::array<float, 13> c{
      0.16666666849016265F,   -0.6666673115835942F,  0.8224668541439328F,   1.81597897385363e-05F,
      -0.6764491402074982F,   0.2704343777651048F,   0.22252640502946153F,  -0.1266598486412002F,
      -0.03917163473587323F,  0.025284261340705144F, 0.004226497275455472F, -0.002409686747089381F,
      -0.0002656517812988568F};
  const Float s = 2.0F * t - 1.0F;
  Float k = c[12] * s + c[11];
  for (std::size_t i = 11; i-- > 0;) k = k * s + c[i];
  return k > 0.0F ? k : Float{};
}

/// 1 − t, as in the paper's published code.
template <class Float>
inline Float linearKernel(const Float& t) {
  return 1.0F - t;
}

}  // namespace csom
