// SPDX-License-Identifier: BSD-3-Clause
#include "rows/RowColumns.h"

#include <algorithm>
#include <cstdlib>

namespace csom::detail {

namespace {

/// Steps beyond are holes, all of them counted as one.
constexpr std::int64_t kLongestStep = 1 << 14;

}  // namespace

std::vector<std::uint32_t> RowColumns::countSteps() {
  std::vector<std::uint32_t> steps(kLongestStep + 1, 0);
  for (std::vector<std::int32_t>& row : columns_) {
    if (!std::is_sorted(row.begin(), row.end())) std::sort(row.begin(), row.end());
    for (std::size_t i = 1; i < row.size(); ++i) {
      const std::int64_t step = std::int64_t{row[i]} - row[i - 1];
      ++steps[static_cast<std::size_t>(std::min(step, kLongestStep))];
    }
  }
  return steps;
}

std::int32_t medianStep(const std::vector<std::uint32_t>& steps) {
  std::size_t all = 0;
  for (std::size_t step = 1; step < steps.size(); ++step) all += steps[step];
  std::size_t below = 0;
  for (std::size_t step = 1; step < steps.size(); ++step) {
    below += steps[step];
    if (2 * below > all) return static_cast<std::int32_t>(step);
  }
  return 1;
}

}  // namespace csom::detail
