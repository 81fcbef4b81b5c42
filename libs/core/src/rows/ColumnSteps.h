// SPDX-License-Identifier: BSD-3-Clause
// How far apart the neighbours of a row are.
#pragma once

#include <csom/core/RangeImage.h>

#include <cstdint>
#include <vector>

namespace csom::detail {

/// How many neighbours of the rows of an image are 0, 1, 2, … columns apart; the last number is
/// that of all that are farther.
using ColumnSteps = std::vector<std::uint32_t>;
ColumnSteps countColumnSteps(const RangeImage& image);

/// The median of the steps that are not 0; at least 1.
std::int32_t medianStep(const ColumnSteps& steps);

/// Whether the beams of each row are evenly spaced, as a turning sensor measures them: at least
/// half of them one step from the next; at most one in ten nearer than 0.4 steps but not at the
/// same place, and at most four in ten there (a second return).
bool areEven(const ColumnSteps& steps);

}  // namespace csom::detail
