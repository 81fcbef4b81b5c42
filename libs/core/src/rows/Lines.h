// SPDX-License-Identifier: BSD-3-Clause
// Clouds that are a grid of directions, line after line: those of cameras, and of organised clouds.
#pragma once

#include <csom/core/RangeImage.h>

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace csom::detail {

/// Lines of equally many points: from one line to the next the direction jumps back, within them it
/// hardly changes. Lines are rows if they run along azimuths, else columns. Nothing if not all
/// lines have the same number of points, 4 at least, or what has the same place in adjacent lines
/// does not lie side by side.
std::optional<RangeImage> findLines(const std::vector<Eigen::Vector3f>& points);

}  // namespace csom::detail
