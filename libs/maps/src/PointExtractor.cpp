// SPDX-License-Identifier: BSD-3-Clause
// The list of all extractors.
#include <csom/maps/PointExtractor.h>

#include <vector>

#include "Extractors.h"

namespace csom {

const PointExtractor* findPointExtractor(const mrpt::obs::CObservation& observation) {
  // A particle filter asks for every particle: made once, which stateless objects allow.
  static const auto extractors = [] {
    std::vector<std::unique_ptr<PointExtractor>> all;
    for (MakePointExtractor* make : kMakePointExtractors) all.push_back(make());
    return all;
  }();
  for (const auto& extractor : extractors) {
    if (extractor->accepts(observation)) return extractor.get();
  }
  return nullptr;
}

}  // namespace csom
