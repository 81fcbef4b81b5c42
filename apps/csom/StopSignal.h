// SPDX-License-Identifier: BSD-3-Clause
// What becomes of the program when it is told to end: Ctrl-C, kill, a terminal that closes.
#pragma once

#include <thread>

namespace csom {

/// While it lives, SIGINT, SIGTERM and SIGHUP end the process as usual, but what it has not
/// finished is removed first (see removeTemporaryPaths()). A signal that was ignored when the
/// program began (nohup) stays ignored. One in a process, in main().
class SignalCleanup {
 public:
  SignalCleanup();
  ~SignalCleanup();
  SignalCleanup(const SignalCleanup&) = delete;
  SignalCleanup& operator=(const SignalCleanup&) = delete;

 private:
  void waitForSignal() const;

  int read_end_ = -1;
  std::thread thread_;
};

/// Such a signal as a question that a command asks when it suits it: while this lives, the first
/// one only makes received() true; the next ends the process. One at a time in a process.
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  bool received() const;
};

}  // namespace csom
