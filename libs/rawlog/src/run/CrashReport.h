// SPDX-License-Identifier: BSD-3-Clause
// A crash inside MRPT becomes one line and an exit code.
#pragma once

#include <array>
#include <csignal>
#include <string>
#include <vector>

namespace csom::detail {

/// While it lives, a crash of this thread ends the process with exit code 1 and `line` on stderr.
///
/// MRPT trusts what it reads: where a damaged length asks for more memory than there is, its
/// aligned allocator returns a null pointer that is written through, and objects nested in objects
/// recurse until the stack ends. Neither can be caught as an exception. One at a time in a process.
class CrashReport {
 public:
  explicit CrashReport(std::string line);
  ~CrashReport();
  CrashReport(const CrashReport&) = delete;
  CrashReport& operator=(const CrashReport&) = delete;

 private:
  static constexpr std::array<int, 4> kSignals{SIGSEGV, SIGBUS, SIGFPE, SIGABRT};

  std::string line_;
  std::vector<char> stack_;  ///< for the handler: the thread's own may have ended
  stack_t stack_before_{};
  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace csom::detail
