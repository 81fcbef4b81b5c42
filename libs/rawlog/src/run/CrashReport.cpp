// SPDX-License-Identifier: BSD-3-Clause
// A crash inside MRPT becomes one line and an exit code.
#include "run/CrashReport.h"

#include <unistd.h>

#include <utility>

namespace csom::detail {
namespace {

// A signal handler has no other way to know what to say.
const std::string* current_line = nullptr;

extern "C" void reportCrash(int) {
  if (write(STDERR_FILENO, current_line->data(), current_line->size()) < 0) _exit(1);
  _exit(1);
}

}  // namespace

CrashReport::CrashReport(std::string line) : line_(std::move(line)), stack_(65536) {
  line_ += '\n';
  current_line = &line_;
  stack_t stack{};
  stack.ss_sp = stack_.data();
  stack.ss_size = stack_.size();
  sigaltstack(&stack, &stack_before_);
  struct sigaction action {};
  action.sa_handler = reportCrash;
  action.sa_flags = SA_ONSTACK;
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &before_[i]);
}

CrashReport::~CrashReport() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
  sigaltstack(&stack_before_, nullptr);
  current_line = nullptr;
}

}  // namespace csom::detail
