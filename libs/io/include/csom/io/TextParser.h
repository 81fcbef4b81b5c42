// SPDX-License-Identifier: BSD-3-Clause
// Lines, columns and numbers of text files, independent of the locale.
#pragma once

#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace csom::detail {

/// The lines of a text, one after the other; "\r\n" ends a line like "\n".
class LineReader {
 public:
  explicit LineReader(std::string_view text) : text_(text) {}

  /// False at the end of the text.
  bool next(std::string_view& line);
  /// Number of the line last read, from 1.
  std::size_t lineNumber() const { return line_number_; }
  /// Byte position behind the line last read.
  std::size_t position() const { return position_; }

 private:
  std::string_view text_;
  std::size_t position_ = 0;
  std::size_t line_number_ = 0;
};

/// Replaces `columns` by the words of a line, which blanks and tabs separate.
void splitColumns(std::string_view line, std::vector<std::string_view>& columns);

/// True if the whole of `text` is a number that fits. Floating-point types also take nan and inf.
template <class Number>
bool parseNumber(std::string_view text, Number& value) {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  return result.ec == std::errc() && result.ptr == end;
}

/// ASCII letters in lower case, all else as it is: for comparisons without regard to case.
std::string lowerCase(std::string_view text);

/// Text from a file as it may be shown on a terminal: control characters, those that change the
/// direction of writing or cannot be seen, and bytes that are no UTF-8 become '?'.
std::string printable(std::string_view text);

/// A word from a file for an error message: printable, shortened, and in quotation marks.
std::string quoted(std::string_view text);

/// "a, b, c".
std::string joined(const std::vector<std::string>& words);

}  // namespace csom::detail
