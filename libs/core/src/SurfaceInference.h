// SPDX-License-Identifier: BSD-3-Clause
// One scan and the options → counts for voxels, by the method surface-csom.
#pragma once

#include <csom/core/CountIncrements.h>
#include <csom/core/Options.h>
#include <csom/core/ScanPreparation.h>
#include <csom/core/ScanReport.h>

namespace csom::detail {

/// Every hit p_i has a kernel k_i along its local surface and a density ρ_i (LocalSurface.h). For
/// the centre v of a voxel, with the sums over the scan's hits, the hits H inside the voxel, and
/// the kernel mass F of free samples:
///
///     V = Σ_{surfaces through v} k_i(v) + w_hit·H
///     S = Σ_{surfaces near v} k_i(v) + w_hit·H                                          (S2)
///     M = max(0, 2τ − S),   g = (g_min + (1 − g_min)·(1 − M/2τ))·min(1, S/0.3)          (S3)
///     Δσ^0 = g·w_counter·(S − V + ρ·M) + max(0, 1 − S/τ)·min(F, F_max)                  (S4)
///     Δσ^k = g·V·m^k/Σm for k ≥ 1                                                       (S5)
///
/// ρ is the mean of ρ_i over S, and m^k = Σ_{hits of class k} k(‖v − p_i‖/max(L_J, reach_i)) the
/// kernel mass of eqs. (16)–(21), no hit's kernel being shorter than its surface's.
///
/// So a voxel is occupied, as far as this scan goes, if at least half of the surfaces that could
/// pass through it do, and if they are more than τ. Both verdicts are evidence.
ScanIncrements surfaceIncrements(const PreparedScan& scan, const Options& options,
                                 ScanReport& report);

}  // namespace csom::detail
