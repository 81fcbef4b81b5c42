// SPDX-License-Identifier: BSD-3-Clause
// Ctrl-C as a question that a command asks when it suits it.
#include "StopSignal.h"

#include <cstddef>

namespace csom {
namespace {

// A signal handler has no other way to tell.
volatile std::sig_atomic_t signal_received = 0;

extern "C" void noteSignal(int) {
  signal_received = 1;
}

}  // namespace

StopSignal::StopSignal() {
  signal_received = 0;
  struct sigaction action {};
  action.sa_handler = noteSignal;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &before_[i]);
}

StopSignal::~StopSignal() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
}

bool StopSignal::received() const {
  return signal_received != 0;
}

}  // namespace csom
