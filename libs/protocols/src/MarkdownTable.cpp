// SPDX-License-Identifier: BSD-3-Clause
#include "MarkdownTable.h"

#include <algorithm>
#include <cstdio>

namespace csom::detail {
namespace {

/// Characters, not bytes, of UTF-8.
std::size_t widthOf(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

}  // namespace

std::string MarkdownTable::text() const {
  std::vector<std::size_t> widths(rows_.front().size(), 3);
  for (const auto& row : rows_)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], widthOf(row[i]));
  std::string out;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    for (std::size_t i = 0; i < widths.size(); ++i) {
      const std::string cell = i < rows_[r].size() ? rows_[r][i] : "";
      const std::string padding(widths[i] - widthOf(cell), ' ');
      out += i == 0 ? "| " + cell + padding : " | " + padding + cell;
    }
    out += " |\n";
    if (r > 0) continue;
    for (std::size_t i = 0; i < widths.size(); ++i)
      out += i == 0 ? "| " + std::string(widths[i], '-')
                    : " | " + std::string(widths[i] - 1, '-') + ":";
    out += " |\n";
  }
  return out + "\n";
}

std::string percent(double share) {
  return fixed(100 * share, 1);
}

std::string fixed(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

}  // namespace csom::detail
