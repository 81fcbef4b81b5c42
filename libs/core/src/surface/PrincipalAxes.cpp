// SPDX-License-Identifier: BSD-3-Clause
#include "surface/PrincipalAxes.h"

#include <cstddef>

namespace csom::detail {

namespace {

/// Off-diagonal elements shrink quadratically: after four sweeps nothing of them is left in single
/// precision.
constexpr int kSweeps = 4;

using Matrix = std::array<std::array<Lanes, 3>, 3>;

/// Turns axes p and q so that a[p][q] becomes 0; r is the third.
CSOM_INLINE void rotate(Matrix& a, Matrix& vectors, std::size_t p, std::size_t q, std::size_t r) {
  const Lanes off = a[p][q];
  const Lanes difference = a[q][q] - a[p][p];
  // tan φ, the smaller root of t² + t·difference/off − 1 = 0.
  const Lanes root = squareRoot(difference * difference + 4 * off * off);
  const Lanes divisor = difference < 0.0F ? difference - root : difference + root;
  const Lanes t = divisor != 0.0F ? 2 * off / divisor : Lanes{};
  const Lanes cosine = 1 / squareRoot(t * t + 1);
  const Lanes sine = t * cosine;
  a[p][p] -= t * off;
  a[q][q] += t * off;
  a[p][q] = a[q][p] = Lanes{};
  const Lanes rp = a[r][p];
  const Lanes rq = a[r][q];
  a[r][p] = a[p][r] = cosine * rp - sine * rq;
  a[r][q] = a[q][r] = sine * rp + cosine * rq;
  for (std::array<Lanes, 3>& row : vectors) {
    const Lanes vp = row[p];
    const Lanes vq = row[q];
    row[p] = cosine * vp - sine * vq;
    row[q] = sine * vp + cosine * vq;
  }
}

CSOM_INLINE void exchangeIf(const IntLanes& condition, Lanes& a, Lanes& b) {
  const Lanes old = a;
  a = condition ? b : a;
  b = condition ? old : b;
}

CSOM_INLINE void orderAxes(Matrix& a, Matrix& vectors, std::size_t i, std::size_t j) {
  const IntLanes wrong = a[j][j] < a[i][i];
  exchangeIf(wrong, a[i][i], a[j][j]);
  for (std::array<Lanes, 3>& row : vectors) exchangeIf(wrong, row[i], row[j]);
}

CSOM_EVERY_PROCESSOR
void decompose(const LaneCovariance& c, PrincipalAxes& axes) {
  const Lanes one = Lanes{} + 1;
  Matrix a{{{c.xx, c.xy, c.xz}, {c.xy, c.yy, c.yz}, {c.xz, c.yz, c.zz}}};
  Matrix vectors{{{one, Lanes{}, Lanes{}}, {Lanes{}, one, Lanes{}}, {Lanes{}, Lanes{}, one}}};
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    rotate(a, vectors, 0, 1, 2);
    rotate(a, vectors, 0, 2, 1);
    rotate(a, vectors, 1, 2, 0);
  }
  orderAxes(a, vectors, 0, 1);
  orderAxes(a, vectors, 1, 2);
  orderAxes(a, vectors, 0, 1);
  for (std::size_t i = 0; i < 3; ++i) {
    axes.variance[i] = a[i][i] > 0.0F ? a[i][i] : Lanes{};
    axes.normal[i] = vectors[i][0];
  }
}

}  // namespace

PrincipalAxes principalAxes(const LaneCovariance& covariance) {
  PrincipalAxes axes;
  decompose(covariance, axes);
  return axes;
}

}  // namespace csom::detail
