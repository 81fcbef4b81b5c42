// SPDX-License-Identifier: BSD-3-Clause
// What a sensor of the log has measured.
#include "ObservationKind.h"

#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationStereoImages.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

namespace csom::detail {

bool isScan3D(const mrpt::obs::CObservation& observation) {
  return dynamic_cast<const mrpt::obs::CObservationVelodyneScan*>(&observation) != nullptr ||
         dynamic_cast<const mrpt::obs::CObservationPointCloud*>(&observation) != nullptr ||
         dynamic_cast<const mrpt::obs::CObservationRotatingScan*>(&observation) != nullptr;
}

bool isImage(const mrpt::obs::CObservation& observation) {
  return dynamic_cast<const mrpt::obs::CObservationImage*>(&observation) != nullptr ||
         dynamic_cast<const mrpt::obs::CObservationStereoImages*>(&observation) != nullptr;
}

}  // namespace csom::detail
