// SPDX-License-Identifier: BSD-3-Clause
// Runs MRPT's own programs with the plug-in.
#pragma once

#include "apps/RunCsom.h"

namespace csom::test {

/// Variables for programs that load the plug-in after their start, or start others with it. A
/// plug-in that AddressSanitizer watches needs the sanitizer there before; MRPT's leaks are not
/// ours.
inline std::vector<std::string> acceptingPlugin() {
  if (std::string(CSOM_ADDRESS_SANITIZER).empty()) return {};
  return {"LD_PRELOAD=" CSOM_ADDRESS_SANITIZER,
          "ASAN_OPTIONS=detect_leaks=0:verify_asan_link_order=0"};
}

/// Variables with which programs preload the plug-in.
inline std::vector<std::string> preloadingPlugin() {
  if (std::string(CSOM_ADDRESS_SANITIZER).empty()) return {"LD_PRELOAD=" CSOM_PLUGIN};
  return {"LD_PRELOAD=" CSOM_ADDRESS_SANITIZER ":" CSOM_PLUGIN, "ASAN_OPTIONS=detect_leaks=0"};
}

/// Runs `PROGRAM ARGUMENTS…` with `folder` as working folder, for `seconds` at most.
inline ProgramResult runMrpt(const std::string& folder, std::vector<std::string> command,
                             int seconds = 120,
                             const std::vector<std::string>& environment = preloadingPlugin()) {
  command.insert(command.begin(), {"-C", folder, "timeout", std::to_string(seconds)});
  return runProgram(folder, "env", command, environment);
}

}  // namespace csom::test
