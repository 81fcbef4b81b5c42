// SPDX-License-Identifier: BSD-3-Clause
// How far a long command has come, on stderr.
#include "Progress.h"

#include <csom/report/Format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <utility>

namespace csom {
namespace {

constexpr auto kTerminalInterval = std::chrono::milliseconds(100);
constexpr auto kPlainInterval = std::chrono::seconds(5);
constexpr int kBarWidth = 30;
constexpr char kWipeLine[] = "\r\033[K";

}  // namespace

Progress::Progress(std::string what)
    : what_(std::move(what)),
      on_terminal_(::isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      last_(start_) {}

Progress::~Progress() {
  if (drawn_ && on_terminal_) std::fputs(kWipeLine, stderr);
}

void Progress::update(std::size_t done, std::size_t total, const std::string& detail) {
  const auto now = Clock::now();
  const auto pause = on_terminal_ ? Clock::duration(kTerminalInterval) : kPlainInterval;
  if (now - last_ < pause || done == 0 || total == 0) return;
  last_ = now;
  drawn_ = true;

  const double share = static_cast<double>(done) / static_cast<double>(total);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const std::string left = formatDuration(elapsed / share - elapsed);
  const std::string state = formatCount(done) + "/" + formatCount(total) + "  " + detail +
                            (detail.empty() ? "" : "  ") + "ETA " + left;
  if (on_terminal_) {
    const auto filled = static_cast<std::size_t>(std::lround(share * kBarWidth));
    const std::string bar = std::string(filled, '#') + std::string(kBarWidth - filled, '.');
    std::fprintf(stderr, "%s%s [%s] %3.0f %%  %s", kWipeLine, what_.c_str(), bar.c_str(),
                 100 * share, state.c_str());
    std::fflush(stderr);
  } else {
    std::fprintf(stderr, "%s %3.0f %%  %s\n", what_.c_str(), 100 * share, state.c_str());
  }
}

}  // namespace csom
