// SPDX-License-Identifier: BSD-3-Clause
// The list of all extractors.
#include <csom/maps/PointExtractor.h>

#include "Extractors.h"

namespace csom {

std::vector<std::unique_ptr<PointExtractor>> makePointExtractors() {
  std::vector<std::unique_ptr<PointExtractor>> extractors;
  extractors.push_back(makeVelodyneExtractor());
  extractors.push_back(makePointCloudExtractor());
  extractors.push_back(makeRangeCameraExtractor());
  extractors.push_back(makeRotatingScanExtractor());
  extractors.push_back(makeLaserScanExtractor());
  return extractors;
}

}  // namespace csom
