// SPDX-License-Identifier: BSD-3-Clause
// The number in the middle.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace csom::detail {

/// Of numbers that need not be sorted, and are in another order afterwards; of an even number of
/// them the upper one. There must be one.
inline float medianOf(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace csom::detail
