// SPDX-License-Identifier: BSD-3-Clause
// Kernel length adapted by class entropy (AKLM).
#pragma once

#include <csom/core/Options.h>

#include <vector>

namespace csom {

/// E_cla of eqs. (10)–(14) from the class mass of a block's points:
///
///     E_p = (n_all − n_max)/n_all (10),  E_s = ln 𝔨 / ln K (11),  E_cla = E_p + E_s/K
///
/// 𝔨 is the number of classes present. 1 if there is no point (14); clamped to [0, 1]. The result
/// is a float on purpose: it swallows the last-bit differences that logarithms of different
/// processors have, so that maps are the same everywhere.
float classEntropy(const std::vector<double>& class_mass);

/// L_J = L_min + E_cla·(L_max − L_min) (15) [m]; the fixed length without AKLM.
float kernelLength(float class_entropy, const Options& options);

}  // namespace csom
