// SPDX-License-Identifier: BSD-3-Clause
// Multi-entropy kernel inference: one scan and the options → counts for voxels.
#pragma once

#include <csom/core/CountIncrements.h>
#include <csom/core/Options.h>
#include <csom/core/ScanPreparation.h>
#include <csom/core/ScanReport.h>

namespace csom {

/// For the centre v_j of each voxel of each filled block, over the training points within L_J:
///
///     Δσ_j^k = Σ_i ε0·k(‖v_j − p_i‖ / L_J)·c_i^k                        (16)–(21)
///
/// summed in single precision in the order of the points (z-major by block), rounded once to the
/// quantum. A voxel's sum depends on nothing but the scan and the options: not on the map, on other
/// voxels, on threads. With s-csm a voxel receives the class mass of the points inside it.
ScanIncrements inferIncrements(const PreparedScan& scan, const Options& options,
                               ScanReport& report);

}  // namespace csom
