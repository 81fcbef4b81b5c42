// SPDX-License-Identifier: BSD-3-Clause
// What becomes of the program when it is told to end.
#include "StopSignal.h"

#include <csom/core/TemporaryPath.h>
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

namespace csom {
namespace {

constexpr std::array<int, 3> kSignals{SIGINT, SIGTERM, SIGHUP};

// A signal handler has no other way to tell.
volatile std::sig_atomic_t is_asked = 0;         // a StopSignal lives
volatile std::sig_atomic_t signal_received = 0;  // since then
volatile std::sig_atomic_t write_end = -1;       // of the pipe to the thread that cleans up

extern "C" void noteSignal(int signal) {
  if (is_asked != 0 && signal_received == 0) {
    signal_received = 1;
    return;
  }
  const int reason = errno;
  const auto number = static_cast<unsigned char>(signal);
  if (write_end >= 0) {
    [[maybe_unused]] const auto written = ::write(write_end, &number, 1);
  }
  errno = reason;
}

/// Blocks all signals in the calling thread while it lives: a thread that is started meanwhile has
/// them blocked for good, so that signals go to the others.
class AllSignalsBlocked {
 public:
  AllSignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~AllSignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  AllSignalsBlocked(const AllSignalsBlocked&) = delete;
  AllSignalsBlocked& operator=(const AllSignalsBlocked&) = delete;

 private:
  sigset_t before_{};
};

[[noreturn]] void endBySignal(int signal) {
  std::signal(signal, SIG_DFL);
  sigset_t only;
  sigemptyset(&only);
  sigaddset(&only, signal);
  pthread_sigmask(SIG_UNBLOCK, &only, nullptr);
  std::raise(signal);
  ::_exit(128 + signal);
}

}  // namespace

SignalCleanup::SignalCleanup() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw std::runtime_error(std::string("no pipe can be made: ") + std::strerror(errno));
  read_end_ = ends[0];
  write_end = ends[1];
  {
    const AllSignalsBlocked blocked;
    thread_ = std::thread([this] { waitForSignal(); });
  }
  for (const int signal : kSignals) {
    struct sigaction action {};
    sigaction(signal, nullptr, &action);
    if (action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = noteSignal;
    action.sa_flags = static_cast<int>(SA_RESTART);
    sigaction(signal, &action, nullptr);
  }
}

SignalCleanup::~SignalCleanup() {
  for (const int signal : kSignals) {
    struct sigaction action {};
    sigaction(signal, nullptr, &action);
    if (action.sa_handler == noteSignal) std::signal(signal, SIG_DFL);
  }
  const int end = write_end;
  write_end = -1;
  ::close(end);  // which ends the thread
  thread_.join();
  ::close(read_end_);
}

void SignalCleanup::waitForSignal() const {
  unsigned char signal = 0;
  ssize_t count = 0;
  do {
    count = ::read(read_end_, &signal, 1);
  } while (count < 0 && errno == EINTR);
  if (count != 1) return;
  removeTemporaryPaths();
  endBySignal(signal);
}

StopSignal::StopSignal() {
  signal_received = 0;
  is_asked = 1;
}

StopSignal::~StopSignal() {
  is_asked = 0;
}

bool StopSignal::received() const {
  return signal_received != 0;
}

}  // namespace csom
