// SPDX-License-Identifier: BSD-3-Clause
// The command line of this process, as one would type it again.
#include "CommandLine.h"

#include <fstream>

namespace csom {

std::string shellQuoted(const std::string& word) {
  constexpr char kPlain[] =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./:=,+@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string commandLine() {
  std::ifstream file("/proc/self/cmdline");
  std::string line, word;
  while (std::getline(file, word, '\0')) line += (line.empty() ? "" : " ") + shellQuoted(word);
  return line;
}

std::string withFlags(const std::string& text, const std::vector<std::string>& options) {
  std::string flags;
  for (const std::string& option : options) flags += (flags.empty() ? " (--" : ", --") + option;
  return text + (flags.empty() ? "" : flags + ")");
}

}  // namespace csom
