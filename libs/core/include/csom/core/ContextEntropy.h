// SPDX-License-Identifier: BSD-3-Clause
// Redundant-voxel filter by context entropy (RVFM): which blocks a scan fills.
#pragma once

#include <csom/core/Options.h>
#include <csom/core/types.h>

#include <cstdint>
#include <vector>

namespace csom {

/// How much of an extended block was observed: the block itself and its neighbours by kind.
struct BlockContext {
  bool observed = false;
  int faces = 0;    ///< of 6, at distance s
  int edges = 0;    ///< of 12, at √2·s
  int corners = 0;  ///< of 8, at √3·s
};

/// E_con of eqs. (4) and (5), in (0, 1).
///
///     E₁ = ω1·[observed] + Σ_{observed neighbours} ω2·exp(−‖b_J−b_x‖²/2s²)          (6)–(8)
///     E_con = exp(E₁) / (exp(E₁) + exp(E₀)),  E₀ the same sum over what is not observed
///
/// The block's edge s cancels: neighbours lie at s, √2·s and √3·s.
double contextEntropy(const BlockContext& context, const Options& options);

/// A block to fill, with the observed block that it is, if any.
struct FilledBlock {
  BlockIndex index;
  std::int32_t observed = -1;  ///< position in `observed_blocks`, −1 if no point lies in it
};

/// All blocks with f_J = [E_con ≥ T_con] = 1 (eq. 9) within the extended blocks of the observed
/// ones, ascending. Without the filter (s-bki, rvfm = off) all of them. `observed_blocks`
/// ascending.
std::vector<FilledBlock> filledBlocks(const std::vector<BlockIndex>& observed_blocks,
                                      const Options& options);

}  // namespace csom
