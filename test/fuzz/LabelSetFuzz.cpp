// SPDX-License-Identifier: BSD-3-Clause
// Label sets: what is read must come back from its own text.
#include <csom/io/LabelSet.h>

#include <cstdlib>

#include "FuzzTarget.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  csom::fuzz::readAsFile(data, size, "labels.yaml", [](const std::string& file) {
    const csom::LabelSet labels = csom::LabelSet::load(file);
    if (!(csom::LabelSet::fromYaml(labels.toYaml(), file) == labels)) std::abort();
  });
  return 0;
}
