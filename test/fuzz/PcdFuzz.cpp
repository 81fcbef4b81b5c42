// SPDX-License-Identifier: BSD-3-Clause
// PCD files, by each policy for irregular rows.
#include <csom/io/PcdReader.h>

#include "FuzzTarget.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using csom::PcdRowPolicy;
  for (const PcdRowPolicy policy :
       {PcdRowPolicy::Refuse, PcdRowPolicy::SkipRow, PcdRowPolicy::IgnoreExtra})
    csom::fuzz::readAsFile(data, size, "input.pcd",
                           [=](const std::string& file) { csom::readPcd(file, policy); });
  return 0;
}
