// SPDX-License-Identifier: BSD-3-Clause
// Another program, run to its end as if it had been started instead of this one.
#include "ChildProcess.h"

#include <csom/core/Error.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace csom {
namespace {

/// Signals that arrive while the other program runs wait until they are fetched.
class HeldSignals {
 public:
  HeldSignals() {
    sigemptyset(&held_);
    for (const int signal : {SIGINT, SIGQUIT, SIGTERM, SIGHUP, SIGCHLD}) sigaddset(&held_, signal);
    sigprocmask(SIG_BLOCK, &held_, &before_);
  }
  ~HeldSignals() { sigprocmask(SIG_SETMASK, &before_, nullptr); }
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

  const sigset_t& before() const { return before_; }
  /// Waits for the next one.
  siginfo_t next() const {
    siginfo_t info{};
    while (sigwaitinfo(&held_, &info) < 0 && errno == EINTR) {
    }
    return info;
  }

 private:
  sigset_t held_{};
  sigset_t before_{};
};

std::vector<char*> pointersTo(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> environmentWith(const std::string& variable, const std::string& value) {
  const std::string start = variable + "=";
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry)
    if (std::strncmp(*entry, start.c_str(), start.size()) != 0) all.emplace_back(*entry);
  all.push_back(start + value);
  return all;
}

pid_t start(std::vector<std::string> command, std::vector<std::string> environment,
            const sigset_t& signal_mask) {
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  posix_spawnattr_setsigmask(&attributes, &signal_mask);
  const std::vector<char*> arguments = pointersTo(command);
  const std::vector<char*> variables = pointersTo(environment);
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, arguments[0], nullptr, &attributes, arguments.data(), variables.data());
  posix_spawnattr_destroy(&attributes);
  if (error != 0)
    throw ConfigError("'" + command.front() + "' cannot be started: " + std::strerror(error));
  return child;
}

}  // namespace

ProgramEnd runToItsEnd(const std::vector<std::string>& command, const std::string& variable,
                       const std::string& value) {
  const HeldSignals signals;
  const pid_t child = start(command, environmentWith(variable, value), signals.before());
  for (;;) {
    const siginfo_t signal = signals.next();
    if (signal.si_signo != SIGCHLD) {
      // What a key of the terminal sends (SI_KERNEL), the other program has received as well.
      if (signal.si_code != SI_KERNEL) kill(child, signal.si_signo);
      continue;
    }
    int status = 0;
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended < 0) throw std::runtime_error(command.front() + ": its end has been missed");
    if (ended == 0) continue;  // it was only stopped, or continued
    if (WIFSIGNALED(status)) return {128 + WTERMSIG(status), WTERMSIG(status)};
    return {WEXITSTATUS(status), 0};
  }
}

}  // namespace csom
