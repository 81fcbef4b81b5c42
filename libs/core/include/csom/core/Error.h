// SPDX-License-Identifier: BSD-3-Clause
// What ends a command before its time: input that is at fault, or the wish of the user.
#pragma once

#include <stdexcept>
#include <string>

namespace csom {

/// A file cannot be read or written, or does not hold what it should. The message is one line:
/// file, place in it (line, byte, row), the value found, and what to do.
class FileError : public std::runtime_error {
 public:
  FileError(const std::string& file, const std::string& reason)
      : std::runtime_error(file + ": " + reason) {}
};

/// A configuration or a command line asks for something impossible. The message names the file,
/// the section or option, and what is accepted.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Somebody wants the program to stop. The message says what is kept.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace csom
