// SPDX-License-Identifier: BSD-3-Clause
// A table of Markdown, filled row by row.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace csom::detail {

class MarkdownTable {
 public:
  /// The first column is text, the others are numbers.
  explicit MarkdownTable(std::vector<std::string> header) : rows_{std::move(header)} {}

  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  bool empty() const { return rows_.size() == 1; }
  /// Columns of equal width, so that it can be read as text too; ends with an empty line.
  std::string text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// 0.3456 → "34.6".
std::string percent(double share);
/// With so many decimals.
std::string fixed(double value, int decimals);

}  // namespace csom::detail
