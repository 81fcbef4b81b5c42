// SPDX-License-Identifier: BSD-3-Clause
// Worlds of the simulator.
#include <csom/eval/Scenario.h>

#include "FuzzTarget.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  csom::fuzz::readAsFile(data, size, "world.yaml",
                         [](const std::string& file) { csom::loadScenario(file); });
  return 0;
}
