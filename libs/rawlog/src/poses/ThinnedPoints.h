// SPDX-License-Identifier: BSD-3-Clause
// Fewer points, evenly spread.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace csom::detail {

/// One point of each cube of `edge` metres that holds any: the one nearest to the mean of them, as
/// the mean itself lies on no surface. In an order that depends on nothing but the points. Points
/// must be finite and within 2²⁰ cubes from the origin.
std::vector<Eigen::Vector3f> thinned(const std::vector<Eigen::Vector3f>& points, float edge);

}  // namespace csom::detail
