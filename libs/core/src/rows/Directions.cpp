// SPDX-License-Identifier: BSD-3-Clause
#include "rows/Directions.h"

#include <cmath>

#include "util/Lanes.h"

namespace csom::detail {

namespace {

constexpr float kQuarter = 9000;  // [0.01°]

/// The angle of (x, y) in [−18000, 18000], to 1/50 of a hundredth of a degree. Not std::atan2(),
/// whose last bit differs from one C library to the next: the map would.
CSOM_INLINE float angleOf(float y, float x) {
  const float ax = x < 0 ? -x : x;
  const float ay = y < 0 ? -y : y;
  const float longer = ax > ay ? ax : ay;
  const float shorter = ax > ay ? ay : ax;
  const float t = longer > 0 ? shorter / longer : 0;
  const float s = t * t;
  // Abramowitz and Stegun, Handbook of Mathematical Functions, 4.4.49, in hundredths of a degree.
  constexpr float kUnit = 5729.57795F;
  const float a =
      t * kUnit *
      (1 +
       s * (-0.3333314528F +
            s * (0.1999355085F +
                 s * (-0.1420889944F +
                      s * (0.1065626393F + s * (-0.0752896400F +
                                                s * (0.0429096138F + s * (-0.0161657367F +
                                                                          s * 0.0028662257F))))))));
  const float octant = ay > ax ? kQuarter - a : a;
  const float half = x < 0 ? 2 * kQuarter - octant : octant;
  return y < 0 ? -half : half;
}

CSOM_EVERY_PROCESSOR
void computeAngles(std::size_t count, const float* x, const float* y, const float* z,
                   std::int32_t* azimuth, float* elevation) {
  for (std::size_t i = 0; i < count; ++i) {
    const float a = angleOf(y[i], x[i]);
    const float positive = a < 0 ? a + kColumnsOfTurn : a;
    const auto column = static_cast<std::int32_t>(positive);
    azimuth[i] = column < kColumnsOfTurn ? column : 0;
    elevation[i] = angleOf(z[i], std::sqrt(x[i] * x[i] + y[i] * y[i]));
  }
}

}  // namespace

Directions::Directions(const std::vector<Eigen::Vector3f>& points) {
  std::vector<float> x, y, z;
  for (std::vector<float>* axis : {&x, &y, &z}) axis->reserve(points.size());
  point.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f& p = points[i];
    // Straight up has no azimuth, and what a float cannot square is no measurement.
    constexpr float kFarthest = 1e9F;
    if (!p.allFinite() || p.cwiseAbs().maxCoeff() > kFarthest) continue;
    if (p.x() == 0 && p.y() == 0) continue;
    point.push_back(static_cast<std::uint32_t>(i));
    x.push_back(p.x());
    y.push_back(p.y());
    z.push_back(p.z());
  }
  azimuth.resize(point.size());
  elevation.resize(point.size());
  computeAngles(point.size(), x.data(), y.data(), z.data(), azimuth.data(), elevation.data());
}

}  // namespace csom::detail
