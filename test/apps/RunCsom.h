// SPDX-License-Identifier: BSD-3-Clause
// Runs the program csom, and MRPT's own, as their users do.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace csom::test {

struct ProgramResult {
  int exit_code = -1;  ///< 128 + signal if a signal ended it
  std::string output;  ///< standard output
  std::string errors;  ///< standard error

  /// Of standard error, but for those that tell progress: on a slow machine there are some.
  std::vector<std::string> errorLines() const {
    static const std::regex progress("[a-z ]+ +[0-9]+ %  .*");
    std::vector<std::string> lines;
    std::istringstream text(errors);
    for (std::string line; std::getline(text, line);)
      if (!std::regex_match(line, progress)) lines.push_back(line);
    return lines;
  }
};

inline std::string shellQuoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// Runs `PROGRAM ARGUMENTS…`; what it prints goes through files in `folder`. `environment`:
/// NAME=value, added to that of the test.
inline ProgramResult runProgram(const std::string& folder, const std::string& program,
                                const std::vector<std::string>& arguments,
                                const std::vector<std::string>& environment = {}) {
  std::string command = "env";
  for (const std::string& variable : environment) command += " " + shellQuoted(variable);
  command += " " + shellQuoted(program);
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

inline ProgramResult runCsom(const std::string& folder, const std::vector<std::string>& arguments) {
  return runProgram(folder, CSOM_PROGRAM, arguments);
}

}  // namespace csom::test
