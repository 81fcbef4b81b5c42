// SPDX-License-Identifier: BSD-3-Clause
// What an exception of MRPT says, in one line.
#include "MrptMessage.h"

namespace csom {

std::string oneLine(const std::string& what) {
  constexpr char kMark[] = "Message:";
  const std::size_t mark = what.find(kMark);
  std::size_t begin = mark == std::string::npos ? 0 : mark + sizeof kMark - 1;
  begin = what.find_first_not_of(" \t\r\n", begin);
  if (begin == std::string::npos) return "unknown reason";
  return what.substr(begin, what.find_first_of("\r\n", begin) - begin);
}

}  // namespace csom
