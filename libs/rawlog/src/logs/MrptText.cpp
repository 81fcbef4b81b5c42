// SPDX-License-Identifier: BSD-3-Clause
// MRPT's words as one line of ours.
#include "logs/MrptText.h"

#include <csom/maps/MrptMessage.h>

namespace csom::detail {

std::string oneLine(const std::exception& error) {
  constexpr std::size_t kLongest = 200;
  std::string text = messageOf(error);
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
