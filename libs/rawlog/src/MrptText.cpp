// SPDX-License-Identifier: BSD-3-Clause
// MRPT's words as one line of ours.
#include "MrptText.h"

namespace csom::detail {

std::string oneLine(const std::exception& error) {
  constexpr std::size_t kLongest = 200;
  std::string text = error.what();
  for (const std::string mark : {"MRPT exception ====", "Message:"}) {
    if (const std::size_t at = text.rfind(mark); at != std::string::npos)
      text.erase(0, at + mark.size());
  }
  const std::size_t begin = text.find_first_not_of(" \t\n");
  if (begin == std::string::npos) return "no reason given";
  text = text.substr(begin, text.find('\n', begin) - begin);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  // What MRPT quotes from a file may be anything; it must not reach a terminal.
  for (char& c : text) {
    if (c < ' ' || c > '~') c = '?';
  }
  return text;
}

std::string shortName(const std::string& class_name) {
  return class_name.substr(class_name.rfind(':') + 1);
}

std::optional<double> secondsOf(const mrpt::Clock::time_point& timestamp) {
  if (timestamp.time_since_epoch().count() == 0) return std::nullopt;
  return mrpt::Clock::toDouble(timestamp);
}

}  // namespace csom::detail
