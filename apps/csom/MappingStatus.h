// SPDX-License-Identifier: BSD-3-Clause
// What a running `csom map` says about itself.
#pragma once

#include <csom/rawlog/MappingRun.h>

#include <string>

namespace csom {

/// "120 scans (35.2/s), 1,234,567 voxels in 16 MB, 12 points rejected, 1 observation refused"; what
/// is zero of the last two is left out. `seconds`: since the run began.
std::string mappingStatus(const MappingProgress& now, double seconds);

}  // namespace csom
