// SPDX-License-Identifier: BSD-3-Clause
// MRPT's words as one line of ours.
#include "MrptText.h"

namespace csom::detail {

std::string oneLine(const std::exception& error) {
  std::string text = error.what();
  static const std::string kMark = "Message:";
  if (const std::size_t mark = text.rfind(kMark); mark != std::string::npos)
    text.erase(0, mark + kMark.size());
  const std::size_t begin = text.find_first_not_of(" \t\n");
  if (begin == std::string::npos) return "no reason given";
  const std::size_t end = text.find('\n', begin);
  return text.substr(begin, end == std::string::npos ? end : end - begin);
}

std::string shortName(const std::string& class_name) {
  return class_name.substr(class_name.rfind(':') + 1);
}

std::optional<double> secondsOf(const mrpt::Clock::time_point& timestamp) {
  if (timestamp.time_since_epoch().count() == 0) return std::nullopt;
  return mrpt::Clock::toDouble(timestamp);
}

}  // namespace csom::detail
