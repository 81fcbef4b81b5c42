// SPDX-License-Identifier: BSD-3-Clause
// The program csom while it runs: to be stopped, killed, limited and waited for.
#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/RunCsom.h"

namespace csom::test {

class RunningProgram {
 public:
  struct Limits {
    std::optional<std::uint64_t> file_size;  ///< RLIMIT_FSIZE [bytes]
  };

  /// Starts `csom ARGUMENTS…`; what it prints goes to files in `folder`.
  RunningProgram(const std::string& folder, const std::vector<std::string>& arguments,
                 const Limits& limits = {})
      : output_(folder + "/running-out.txt"), errors_(folder + "/running-err.txt") {
    std::vector<std::string> words{CSOM_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ < 0) throw std::runtime_error("cannot fork");
    if (pid_ > 0) return;
    redirect(output_, STDOUT_FILENO);
    redirect(errors_, STDERR_FILENO);
    if (limits.file_size) {
      const rlimit limit{*limits.file_size, *limits.file_size};
      ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  ~RunningProgram() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
    ::unlink(output_.c_str());
    ::unlink(errors_.c_str());
  }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  void send(int signal) const { ::kill(pid_, signal); }
  bool isRunning() {
    if (pid_ > 0 && ::waitpid(pid_, &status_, WNOHANG) == pid_) pid_ = -1;
    return pid_ > 0;
  }
  /// Waits for its end; exit_code is 128 + signal if a signal ended it.
  ProgramResult wait() {
    if (pid_ > 0) ::waitpid(pid_, &status_, 0);
    pid_ = -1;
    ProgramResult result{-1, textOf(output_), textOf(errors_)};
    if (WIFEXITED(status_)) result.exit_code = WEXITSTATUS(status_);
    if (WIFSIGNALED(status_)) result.exit_code = 128 + WTERMSIG(status_);
    return result;
  }

 private:
  static void redirect(const std::string& file, int descriptor) {
    const int opened = ::open(file.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
    ::dup2(opened, descriptor);
  }
  static std::string textOf(const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }

  std::string output_, errors_;
  pid_t pid_ = -1;
  int status_ = 0;
};

}  // namespace csom::test
