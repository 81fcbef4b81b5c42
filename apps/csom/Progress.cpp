// SPDX-License-Identifier: BSD-3-Clause
// How far a long command has come, on stderr.
#include "Progress.h"

#include <csom/report/Format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <utility>

namespace csom {
namespace {

constexpr auto kTerminalInterval = std::chrono::milliseconds(100);
constexpr auto kPlainInterval = std::chrono::seconds(5);
constexpr int kBarWidth = 20;
constexpr char kWipeLine[] = "\r\033[K";

std::size_t terminalWidth() {
  winsize size{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

}  // namespace

Progress::Progress(std::string what)
    : what_(std::move(what)),
      on_terminal_(::isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      last_(start_) {}

Progress::~Progress() {
  if (drawn_ && on_terminal_) std::fputs(kWipeLine, stderr);
}

void Progress::update(std::size_t done, std::size_t total, const Detail& detail) {
  const auto now = Clock::now();
  const auto pause = on_terminal_ ? Clock::duration(kTerminalInterval) : kPlainInterval;
  if (now - last_ < pause || done == 0 || total == 0) return;
  last_ = now;
  drawn_ = true;

  const double share = static_cast<double>(done) / static_cast<double>(total);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  std::string state = formatCount(done) + "/" + formatCount(total) + "  ETA " +
                      formatDuration(elapsed / share - elapsed);
  if (detail) state += "  " + detail(elapsed);
  draw(share, state);
}

void Progress::draw(double share, const std::string& state) const {
  char percent[16];
  std::snprintf(percent, sizeof percent, "%3.0f %%", 100 * share);
  if (!on_terminal_) {
    std::fprintf(stderr, "%s %s  %s\n", what_.c_str(), percent, state.c_str());
    return;
  }
  const auto filled = static_cast<std::size_t>(std::lround(share * kBarWidth));
  const std::string line = what_ + " [" + std::string(filled, '#') +
                           std::string(kBarWidth - filled, '.') + "] " + percent + "  " + state;
  // A line that wraps could not be wiped.
  std::fprintf(stderr, "%s%s", kWipeLine, line.substr(0, terminalWidth() - 1).c_str());
  std::fflush(stderr);
}

}  // namespace csom
