// SPDX-License-Identifier: BSD-3-Clause
// The kernels of eq. (19), as functions of the relative distance t = d/L.
#pragma once

#include <array>
#include <cstddef>

namespace csom {

/// The sparse kernel, (2+cos 2πt)/3·(1−t) + sin(2πt)/(2π) for t in [0, 1) and 0 from there on,
/// within 3e-7 of the closed form. With u = 1−t the closed form is an odd series in u that begins
/// with u⁵: a polynomial of degree 6 in 1−u² (minimax fit) does for the rest. All its terms are
/// positive, so nothing cancels. A polynomial, because sums and products give the same bits on
/// every processor and in every SIMD lane; sines do not. Its even and odd terms are summed side by
/// side: the processor need not wait for one sum after the other. `Float` is float or a SIMD vector
/// of floats. t ≥ 0.
template <class Float>
__attribute__((always_inline)) inline Float sparseKernel(const Float& t) {
  constexpr std::array<float, 7> c{1.0F,
                                   2.499993085861206F,
                                   2.7302396297454834F,
                                   1.6261119842529297F,
                                   0.6161576509475708F,
                                   0.14337411522865295F,
                                   0.04261443018913269F};
  const Float rest = 1.0F - t;
  const Float u = rest > 0.0F ? rest : Float{};
  const Float w = u * u;
  const Float v = 1.0F - w;
  const Float v2 = v * v;
  const Float even = ((c[6] * v2 + c[4]) * v2 + c[2]) * v2 + c[0];
  const Float odd = (c[5] * v2 + c[3]) * v2 + c[1];
  return (even + v * odd) * (w * w * u);
}

/// 1 − t for t in [0, 1), 0 from there on, as in the paper's published code.
template <class Float>
__attribute__((always_inline)) inline Float linearKernel(const Float& t) {
  const Float rest = 1.0F - t;
  return rest > 0.0F ? rest : Float{};
}

}  // namespace csom
