// SPDX-License-Identifier: BSD-3-Clause
// What all importers of data sets share.
#include <csom/core/Error.h>
#include <csom/rawlog/Import.h>

#include <algorithm>
#include <cctype>
#include <charconv>

namespace csom {
namespace {

bool isDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// The digits from `at` on without leading zeros; moves `at` behind them.
std::string digitsAt(const std::string& text, std::size_t& at) {
  std::size_t begin = at;
  while (at < text.size() && isDigit(text[at])) ++at;
  while (begin + 1 < at && text[begin] == '0') ++begin;
  return text.substr(begin, at - begin);
}

std::optional<std::size_t> numberOf(const std::string& text, const std::string& whole) {
  if (text.empty()) return std::nullopt;
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw ConfigError("scans '" + whole + "': expected a:b, the scans a to b-1, such as 0:100",
                      {"scans"});
  return value;
}

}  // namespace

bool naturalLess(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (isDigit(a[i]) && isDigit(b[j])) {
      const std::string m = digitsAt(a, i);
      const std::string n = digitsAt(b, j);
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  // Equal but for leading zeros: any fixed order will do.
  if (i == a.size() && j == b.size()) return a < b;
  return i == a.size();
}

ScanSelection ScanSelection::parse(const std::string& range, std::size_t every) {
  ScanSelection selection;
  if (every == 0) throw ConfigError("every 0-th scan: expected 1 or more", {"every"});
  selection.every = every;
  if (range.empty()) return selection;
  const std::size_t colon = range.find(':');
  if (colon == std::string::npos) numberOf(":", range);
  selection.first = numberOf(range.substr(0, colon), range).value_or(0);
  selection.end = numberOf(range.substr(colon + 1), range);
  return selection;
}

std::vector<std::size_t> ScanSelection::positions(std::size_t count) const {
  std::vector<std::size_t> chosen;
  const std::size_t last = std::min(count, end.value_or(count));
  for (std::size_t i = first; i < last; i += every) chosen.push_back(i);
  return chosen;
}

}  // namespace csom
