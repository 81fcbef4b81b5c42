// SPDX-License-Identifier: BSD-3-Clause
// Files beside a log that its observations refer to.
#pragma once

#include <mrpt/obs/CObservation.h>

#include <string>
#include <vector>

namespace csom::detail {

/// Paths of the externalised images and clouds of an observation, which may be missing.
std::vector<std::string> externalFilesOf(const mrpt::obs::CObservation& observation);

}  // namespace csom::detail
