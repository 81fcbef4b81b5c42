// SPDX-License-Identifier: BSD-3-Clause
// What a sensor of the log has measured.
#include "logs/ObservationKind.h"

#include <csom/maps/PointExtractor.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationStereoImages.h>

namespace csom::detail {

bool isScan3D(const mrpt::obs::CObservation& observation) {
  const PointExtractor* extractor = findPointExtractor(observation);
  return extractor != nullptr && extractor->seesAllAround();
}

bool isImage(const mrpt::obs::CObservation& observation) {
  return dynamic_cast<const mrpt::obs::CObservationImage*>(&observation) != nullptr ||
         dynamic_cast<const mrpt::obs::CObservationStereoImages*>(&observation) != nullptr;
}

}  // namespace csom::detail
