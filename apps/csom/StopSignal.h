// SPDX-License-Identifier: BSD-3-Clause
// Ctrl-C as a question that a command asks when it suits it.
#pragma once

#include <array>
#include <csignal>

namespace csom {

/// While it lives, the first SIGINT or SIGTERM only makes received() true; a second one ends the
/// process as usual. One at a time in a process.
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  bool received() const;

 private:
  static constexpr std::array<int, 2> kSignals{SIGINT, SIGTERM};
  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace csom
