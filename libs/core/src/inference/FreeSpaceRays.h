// SPDX-License-Identifier: BSD-3-Clause
// Free space by ray casting: the voxels that a scan's beams cross.
#pragma once

#include <csom/core/CountIncrements.h>
#include <csom/core/Options.h>
#include <csom/core/ScanPreparation.h>
#include <csom/core/ScanReport.h>

namespace csom::detail {

/// `count` of class 0 [quanta] for each voxel that the beam of any down-sampled hit crosses, once a
/// scan. Voxels with an accepted point (also before down-sampling) and those of the beams' ends
/// receive nothing. The increments are rounded on their own, apart from those of the kernels.
ScanIncrements castFreeSpace(const PreparedScan& scan, const Options& options, std::uint32_t count,
                             ScanReport& report);

}  // namespace csom::detail
