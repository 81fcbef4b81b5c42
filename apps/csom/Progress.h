// SPDX-License-Identifier: BSD-3-Clause
// How far a long command has come, on stderr.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace csom {

/// On a terminal a bar with the time left, redrawn ten times a second and wiped at the end;
/// elsewhere a plain line every few seconds, so that short runs print nothing.
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(std::size_t done, std::size_t total, const std::string& detail = "");

 private:
  using Clock = std::chrono::steady_clock;

  std::string what_;
  bool on_terminal_;
  bool drawn_ = false;
  Clock::time_point start_;
  Clock::time_point last_;
};

}  // namespace csom
