// SPDX-License-Identifier: BSD-3-Clause
#include "TextParser.h"

#include <algorithm>

namespace csom::detail {

bool LineReader::next(std::string_view& line) {
  if (position_ >= text_.size()) return false;
  const std::size_t end = std::min(text_.find('\n', position_), text_.size());
  line = text_.substr(position_, end - position_);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  position_ = std::min(end + 1, text_.size());
  ++line_number_;
  return true;
}

void splitColumns(std::string_view line, std::vector<std::string_view>& columns) {
  constexpr std::string_view blanks = " \t";
  columns.clear();
  for (std::size_t begin = line.find_first_not_of(blanks); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(blanks, begin), line.size());
    columns.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(blanks, end);
  }
}

std::string quoted(std::string_view text) {
  constexpr std::size_t max_length = 60;
  std::string result = "'";
  for (const char c : text.substr(0, max_length)) {
    const bool printable = static_cast<unsigned char>(c) >= 0x20 && c != 0x7f;
    result += printable ? c : '?';
  }
  return result + (text.size() > max_length ? "…'" : "'");
}

}  // namespace csom::detail
