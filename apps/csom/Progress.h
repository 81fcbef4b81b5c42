// SPDX-License-Identifier: BSD-3-Clause
// How far a long command has come, on stderr.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

namespace csom {

/// On a terminal a bar with the time left, redrawn ten times a second, never longer than a line,
/// and wiped at the end; elsewhere a plain line every few seconds, so that short runs print
/// nothing.
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Told the seconds since the beginning. Asked only when something is printed.
  using Detail = std::function<std::string(double seconds)>;

  void update(std::size_t done, std::size_t total, const Detail& detail = {});

 private:
  using Clock = std::chrono::steady_clock;

  void draw(double share, const std::string& state) const;

  std::string what_;
  bool on_terminal_;
  bool drawn_ = false;
  Clock::time_point start_;
  Clock::time_point last_;
};

}  // namespace csom
