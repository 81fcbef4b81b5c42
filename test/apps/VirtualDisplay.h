// SPDX-License-Identifier: BSD-3-Clause
// Programs with windows, on a screen that only exists in a file.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace csom::test {

/// A program in the background; it is ended when this goes out of scope.
class BackgroundProgram {
 public:
  /// `environment`: NAME=value besides that of the test. What it prints goes to `output`.
  BackgroundProgram(std::vector<std::string> command, const std::vector<std::string>& environment,
                    const std::string& output) {
    std::vector<std::string> all = environment;
    for (char** entry = environ; *entry != nullptr; ++entry) all.emplace_back(*entry);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, output.c_str(), O_WRONLY | O_CREAT | O_APPEND,
                                     0644);
    posix_spawn_file_actions_adddup2(&actions, 1, 2);
    const int error = posix_spawnp(&process_, command[0].c_str(), &actions, nullptr,
                                   pointersTo(command).data(), pointersTo(all).data());
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw std::runtime_error(command[0] + " cannot be started");
  }
  ~BackgroundProgram() {
    if (!isRunning()) return;
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  BackgroundProgram(const BackgroundProgram&) = delete;
  BackgroundProgram& operator=(const BackgroundProgram&) = delete;

  bool isRunning() {
    if (process_ != 0 && waitpid(process_, nullptr, WNOHANG) == process_) process_ = 0;
    return process_ != 0;
  }
  /// True if a library of this name is loaded into it.
  bool hasLoaded(const std::string& library) const {
    std::ifstream maps("/proc/" + std::to_string(process_) + "/maps");
    const std::string text{std::istreambuf_iterator<char>(maps), {}};
    return text.find(library) != std::string::npos;
  }

 private:
  static std::vector<char*> pointersTo(std::vector<std::string>& texts) {
    std::vector<char*> pointers;
    for (std::string& text : texts) pointers.push_back(text.data());
    pointers.push_back(nullptr);
    return pointers;
  }
  pid_t process_ = 0;
};

/// Waits until `condition` holds, but not for ever. False if it never did.
inline bool eventually(const std::function<bool()>& condition) {
  constexpr auto kStep = std::chrono::milliseconds(100);
  constexpr int kSteps = 1200;
  for (int i = 0; i < kSteps; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(kStep);
  }
  return false;
}

/// A screen of 640 x 480 pixels; its files go into `folder`.
class VirtualDisplay {
 public:
  explicit VirtualDisplay(const std::string& folder)
      : folder_(folder),
        server_({"sh", "-c",
                 "exec Xvfb -displayfd 3 -screen 0 640x480x24 -nolisten tcp -fbdir '" + folder +
                     "' 3>'" + folder + "/display'"},
                {}, folder + "/xvfb.txt") {
    const auto has_started = [&] { return !number().empty() || !server_.isRunning(); };
    if (!eventually(has_started) || number().empty())
      throw std::runtime_error("Xvfb does not start");
  }

  std::string name() const { return ":" + number(); }

  struct Pixel {
    std::uint8_t blue, green, red, unused;
  };
  /// What the screen shows now: the file is in the format of xwd.
  std::vector<Pixel> pixels() const {
    std::ifstream file(folder_ + "/Xvfb_screen0", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    constexpr std::size_t kHeaderSize = 0;
    constexpr std::size_t kColors = 19;
    if (bytes.size() < 100) return {};
    const std::size_t begin = word(bytes, kHeaderSize) + 12 * word(bytes, kColors);
    std::vector<Pixel> pixels;
    for (std::size_t at = begin; at + 4 <= bytes.size(); at += 4) {
      const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes[at + i]); };
      pixels.push_back({byte(0), byte(1), byte(2), byte(3)});
    }
    return pixels;
  }

 private:
  /// A number of the header, which is big-endian.
  static std::size_t word(const std::string& bytes, std::size_t index) {
    std::size_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
      value = 256 * value + static_cast<std::uint8_t>(bytes[4 * index + i]);
    return value;
  }
  std::string number() const {
    std::ifstream file(folder_ + "/display");
    std::string number;
    std::string line;
    // Written with its line break when the screen is ready.
    if (std::getline(file, line) && !file.eof()) number = line;
    return number;
  }

  std::string folder_;
  BackgroundProgram server_;
};

}  // namespace csom::test
