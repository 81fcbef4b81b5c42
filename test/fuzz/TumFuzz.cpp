// SPDX-License-Identifier: BSD-3-Clause
// Trajectories as TUM writes them.
#include <csom/io/TrajectoryFile.h>

#include "FuzzTarget.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  csom::fuzz::readAsFile(data, size, "input.tum",
                         [](const std::string& file) { csom::readTumTrajectory(file); });
  return 0;
}
