// SPDX-License-Identifier: BSD-3-Clause
// One scan and the options → counts for voxels, by whichever method the options name.
#pragma once

#include <csom/core/CountIncrements.h>
#include <csom/core/Options.h>
#include <csom/core/ScanPreparation.h>
#include <csom/core/ScanReport.h>

#include "image/ImageInference.h"

namespace csom::detail {

/// What one scan adds to a map. Depends on nothing but the scan and the options: not on the map, on
/// other voxels, on threads.
ScanIncrements inferIncrements(const PreparedScan& scan, const Options& options, ScanReport& report,
                               ImageMemory& memory);

}  // namespace csom::detail
