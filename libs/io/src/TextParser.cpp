// SPDX-License-Identifier: BSD-3-Clause

#include <csom/io/TextParser.h>

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

std::string printable(std::string_view text) {
  std::string result;
  bool after_c2 = false;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    // U+0080 to U+009F, which UTF-8 writes with a leading C2, steer terminals as well.
    const bool second_half_of_control = after_c2 && byte >= 0x80 && byte < 0xa0;
    if (second_half_of_control)
      result.back() = '?';
    else
      result += byte < 0x20 || byte == 0x7f ? '?' : c;
    after_c2 = byte == 0xc2;
  }
  return result;
}

std::string quoted(std::string_view text) {
  constexpr std::size_t max_length = 60;
  return "'" + printable(text.substr(0, max_length)) + (text.size() > max_length ? "…'" : "'");
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace csom::detail
