// SPDX-License-Identifier: BSD-3-Clause
// Runs the program csom as its users do.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace csom::test {

struct ProgramResult {
  int exit_code = -1;  ///< 128 + signal if a signal ended it
  std::string output;  ///< standard output
  std::string errors;  ///< standard error
};

inline std::string shellQuoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// Runs `csom ARGUMENTS…`; what it prints goes through files in `folder`.
inline ProgramResult runCsom(const std::string& folder, const std::vector<std::string>& arguments) {
  std::string command = shellQuoted(CSOM_PROGRAM);
  for (const std::string& argument : arguments) command += " " + shellQuoted(argument);
  const std::string output = folder + "/stdout.txt";
  const std::string errors = folder + "/stderr.txt";
  command += " </dev/null >" + shellQuoted(output) + " 2>" + shellQuoted(errors);

  const int status = std::system(command.c_str());
  const auto textOf = [](const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  };
  ProgramResult result{-1, textOf(output), textOf(errors)};
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.exit_code = 128 + WTERMSIG(status);
  std::filesystem::remove(output);
  std::filesystem::remove(errors);
  return result;
}

}  // namespace csom::test
