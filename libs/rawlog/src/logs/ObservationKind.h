// SPDX-License-Identifier: BSD-3-Clause
// What a sensor of the log has measured.
#pragma once

#include <mrpt/obs/CObservation.h>

namespace csom::detail {

/// True for the kinds that registration takes, see PointExtractor::seesAllAround().
bool isScan3D(const mrpt::obs::CObservation& observation);

/// True for CObservationImage and CObservationStereoImages.
bool isImage(const mrpt::obs::CObservation& observation);

}  // namespace csom::detail
