// SPDX-License-Identifier: BSD-3-Clause
#include "rows/ColumnSteps.h"

#include <algorithm>
#include <cstddef>

namespace csom::detail {

namespace {

/// Steps beyond are holes, all of them counted as one.
constexpr std::int64_t kLongestStep = 1 << 14;

}  // namespace

ColumnSteps countColumnSteps(const RangeImage& image) {
  std::size_t rows = 0;
  for (const RangeImage::Pixel& pixel : image.pixels)
    if (pixel.row != RangeImage::kNoRow) rows = std::max<std::size_t>(rows, pixel.row + 1U);
  std::vector<std::vector<std::int32_t>> columns(rows);
  for (const RangeImage::Pixel& pixel : image.pixels)
    if (pixel.row != RangeImage::kNoRow) columns[pixel.row].push_back(pixel.column);
  ColumnSteps steps(kLongestStep + 1, 0);
  for (std::vector<std::int32_t>& row : columns) {
    if (!std::is_sorted(row.begin(), row.end())) std::sort(row.begin(), row.end());
    for (std::size_t i = 1; i < row.size(); ++i) {
      const std::int64_t step = std::int64_t{row[i]} - row[i - 1];
      ++steps[static_cast<std::size_t>(std::min(step, kLongestStep))];
    }
  }
  return steps;
}

std::int32_t medianStep(const ColumnSteps& steps) {
  std::size_t all = 0;
  for (std::size_t step = 1; step < steps.size(); ++step) all += steps[step];
  std::size_t below = 0;
  for (std::size_t step = 1; step < steps.size(); ++step) {
    below += steps[step];
    if (2 * below > all) return static_cast<std::int32_t>(step);
  }
  return 1;
}

bool areEven(const ColumnSteps& steps) {
  const auto step = static_cast<std::size_t>(medianStep(steps));
  std::size_t all = 0;
  std::size_t even = 0;
  std::size_t same = 0;
  std::size_t near = 0;
  for (std::size_t columns = 0; columns < steps.size(); ++columns) {
    const std::size_t count = steps[columns];
    all += count;
    if (columns <= 1 && step > 2)
      same += count;
    else if (10 * columns < 4 * step)
      near += count;
    if (10 * columns >= 6 * step && 10 * columns <= 16 * step) even += count;
  }
  return 2 * even >= all - same && 10 * near <= all && 10 * same <= 4 * all;
}

}  // namespace csom::detail
