// SPDX-License-Identifier: BSD-3-Clause
// Where the beams of a cloud point to.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace csom::detail {

/// Units of a turn, a hundredth of a degree each.
constexpr std::int32_t kColumnsOfTurn = 36000;

/// The beams that returned something, in the order of the cloud, an array for each property.
struct Directions {
  explicit Directions(const std::vector<Eigen::Vector3f>& points);

  std::size_t size() const { return point.size(); }

  std::vector<std::uint32_t> point;   ///< of the cloud
  std::vector<std::int32_t> azimuth;  ///< 0 … kColumnsOfTurn − 1, from x to y
  std::vector<float> elevation;       ///< above the xy plane [0.01°]
};

/// The azimuth from b to a, the shorter way: −18000 … 17999.
inline std::int32_t turnFrom(std::int32_t b, std::int32_t a) {
  std::int32_t d = a - b;
  if (d < -kColumnsOfTurn / 2) d += kColumnsOfTurn;
  if (d >= kColumnsOfTurn / 2) d -= kColumnsOfTurn;
  return d;
}

}  // namespace csom::detail
