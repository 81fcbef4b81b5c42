// SPDX-License-Identifier: BSD-3-Clause
#include <csom/maps/MrptMessage.h>

namespace csom::detail {

std::string messageOf(const std::exception& error) {
  std::string text = error.what();
  for (const std::string mark : {"MRPT exception ====", "Message:"}) {
    if (const std::size_t at = text.rfind(mark); at != std::string::npos)
      text.erase(0, at + mark.size());
  }
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos) return "no reason given";
  return text.substr(begin, text.find_first_of("\r\n", begin) - begin);
}

}  // namespace csom::detail
