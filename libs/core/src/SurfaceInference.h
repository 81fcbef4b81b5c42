// SPDX-License-Identifier: BSD-3-Clause
// One scan and the options → counts for voxels, by the method surface-csom.
#pragma once

#include <csom/core/CountIncrements.h>
#include <csom/core/Options.h>
#include <csom/core/ScanPreparation.h>
#include <csom/core/ScanReport.h>

namespace csom::detail {

/// Every hit p_i has a kernel k_i along its local surface (LocalSurface.h). For the centre v of a
/// voxel, with the sums over the scan's hits and the hits H inside the voxel:
///
///     V = Σ_{surfaces through v} k_i(v) + w_hit·H,   S = Σ_{surfaces near v} k_i(v) + w_hit·H   (S2)
///     T = max(S, 2τ),   g = g_min + (1 − g_min)·min(1, S/2τ)                                     (S3)
///     Δσ^0 = g·w_counter·(T − V) + mass of free samples                                          (S4)
///     Δσ^k = g·V·m^k/Σm for k ≥ 1, m^k the kernel mass of eqs. (16)–(21)                         (S5)
///
/// So a voxel is occupied, as far as this scan goes, if at least half of the surfaces that could
/// pass through it do, and if they are more than τ. Both verdicts are evidence.
ScanIncrements surfaceIncrements(const PreparedScan& scan, const Options& options,
                                 ScanReport& report);

}  // namespace csom::detail
