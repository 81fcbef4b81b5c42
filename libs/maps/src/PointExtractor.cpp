// SPDX-License-Identifier: BSD-3-Clause
// The list of all extractors.
#include <csom/maps/PointExtractor.h>

#include <array>

#include "Extractors.h"

namespace csom {

const PointExtractor* findPointExtractor(const mrpt::obs::CObservation& observation) {
  // A particle filter asks for every particle: made once, which stateless objects allow.
  static const std::array<std::unique_ptr<PointExtractor>, 5> extractors = {
      makeVelodyneExtractor(), makePointCloudExtractor(), makeRangeCameraExtractor(),
      makeRotatingScanExtractor(), makeLaserScanExtractor()};
  for (const auto& extractor : extractors) {
    if (extractor->accepts(observation)) return extractor.get();
  }
  return nullptr;
}

}  // namespace csom
