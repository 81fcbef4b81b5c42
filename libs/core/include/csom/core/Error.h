// SPDX-License-Identifier: BSD-3-Clause
// What ends a command before its time: input that is at fault, or the wish of the user.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace csom {

/// What this project throws for a cause outside of the program. The message is one line for the
/// user: the file and the place in it, or the option; the value found; what is accepted or what to
/// do.
class Error : public std::runtime_error {
 public:
  /// `options`: names of options that help, as a program may offer them: "box", "poses icp".
  explicit Error(const std::string& message, std::vector<std::string> options = {})
      : std::runtime_error(message), message_(message), options_(std::move(options)) {}

  const char* what() const noexcept override { return message_.c_str(); }
  const std::vector<std::string>& options() const { return options_; }
  /// Adds to the message what a caller knows: catch (Error& error) { error.append(…); throw; }
  void append(const std::string& text) { message_ += text; }

 private:
  std::string message_;
  std::vector<std::string> options_;
};

/// A file cannot be read or written, or does not hold what it should.
class FileError : public Error {
 public:
  FileError(const std::string& file, const std::string& reason,
            std::vector<std::string> options = {})
      : Error(file + ": " + reason, std::move(options)) {}
};

/// A configuration or a request asks for something impossible.
class ConfigError : public Error {
 public:
  using Error::Error;
};

/// Somebody wants the program to stop. The message says what is kept.
class Interrupted : public Error {
 public:
  using Error::Error;
};

}  // namespace csom
