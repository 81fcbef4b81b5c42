// SPDX-License-Identifier: BSD-3-Clause
// Map files, to those who load, verify and repair them.
#include <csom/io/MapFile.h>
#include <csom/io/MapRepair.h>

#include "FuzzTarget.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  csom::fuzz::readAsFile(data, size, "map.csom",
                         [](const std::string& file) { csom::loadMap(file); });
  csom::fuzz::readAsFile(data, size, "map.csom",
                         [](const std::string& file) { csom::verifyMap(file); });
  csom::fuzz::readAsFile(data, size, "map.csom",
                         [](const std::string& file) { csom::recoverMap(file); });
  return 0;
}
