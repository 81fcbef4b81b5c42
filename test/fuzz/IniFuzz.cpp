// SPDX-License-Identifier: BSD-3-Clause
// The ini of a map, as csom map and MRPT's programs read it.
#include <csom/maps/CSemanticContinuousMap.h>

#include "FuzzTarget.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  csom::fuzz::readAsFile(data, size, "map.ini", [](const std::string& file) {
    const auto definition = csom::CSemanticContinuousMap::definitionFromIni(file);
    const csom::CSemanticContinuousMap map(definition);
  });
  return 0;
}
