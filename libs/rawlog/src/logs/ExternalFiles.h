// SPDX-License-Identifier: BSD-3-Clause
// Files beside a log that its observations refer to.
#pragma once

#include <mrpt/obs/CObservation.h>

#include <string>
#include <vector>

namespace csom::detail {

/// Paths of the externalised images and clouds of an observation, which may be missing.
std::vector<std::string> listExternalFiles(const mrpt::obs::CObservation& observation);

/// Reads externalised images into memory. Those that cannot be read are left to who needs them.
void loadImages(mrpt::obs::CObservation& observation);

/// A copy whose images are found from any working folder, and are not in memory; the observation
/// itself if it has no externalised images.
mrpt::obs::CObservation::Ptr withAbsoluteImagePaths(
    const mrpt::obs::CObservation::Ptr& observation);

}  // namespace csom::detail
