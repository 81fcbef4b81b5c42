// SPDX-License-Identifier: BSD-3-Clause
// Vectors of three floats whose sums run in the order that the definitions of facets name.
#pragma once

namespace csom::detail {

struct BeamVector {
  float x, y, z;
};

inline BeamVector between(const BeamVector& a, const BeamVector& b) {
  return {b.x - a.x, b.y - a.y, b.z - a.z};
}
inline float dot(const BeamVector& a, const BeamVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline float squaredNorm(const BeamVector& a) {
  return dot(a, a);
}
/// Of the cross product.
inline float squaredCross(const BeamVector& a, const BeamVector& b) {
  return squaredNorm({a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x});
}

}  // namespace csom::detail
