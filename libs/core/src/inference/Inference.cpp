// SPDX-License-Identifier: BSD-3-Clause
#include "inference/Inference.h"

#include <csom/core/Method.h>

#include <algorithm>

namespace csom::detail {

const MethodEntry& entryOf(Method method) {
  const auto entry = std::find_if(kMethods.begin(), kMethods.end(),
                                  [&](const MethodEntry& e) { return e.method == method; });
  if (entry == kMethods.end()) rejectOption("method", "invalid", acceptedWords(method));
  return *entry;
}

ScanIncrements inferIncrements(const PreparedScan& scan, const Options& options, ScanReport& report,
                               ImageMemory& memory) {
  ScanIncrements increments;
  if (!scan.image_points.points.empty())
    increments = inferFromImage(scan, options, report, memory);
  else if (!scan.blocks.empty())
    increments = entryOf(options.method).infer(scan, options, report);
  increments.erase(std::remove_if(increments.begin(), increments.end(),
                                  [](const ChunkIncrements& chunk) { return chunk.empty(); }),
                   increments.end());
  return increments;
}

}  // namespace csom::detail
