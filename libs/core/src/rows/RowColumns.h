// SPDX-License-Identifier: BSD-3-Clause
// The columns at which the rows of an image have beams.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace csom::detail {

class RowColumns {
 public:
  explicit RowColumns(std::size_t rows) : columns_(rows) {}

  void add(std::size_t row, std::int32_t column) { columns_[row].push_back(column); }
  /// How many neighbours of a row are 0, 1, 2, … columns apart. Sorts the rows.
  std::vector<std::uint32_t> countSteps();

 private:
  std::vector<std::vector<std::int32_t>> columns_;
};

/// The median of the steps that are not 0; at least 1.
std::int32_t medianStep(const std::vector<std::uint32_t>& steps);

}  // namespace csom::detail
