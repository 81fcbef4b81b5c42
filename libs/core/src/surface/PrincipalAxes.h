// SPDX-License-Identifier: BSD-3-Clause
// Eigenvalues of small covariances, eight at a time.
#pragma once

#include <array>

#include "util/Lanes.h"

namespace csom::detail {

/// A covariance of three coordinates a lane.
struct LaneCovariance {
  Lanes xx{}, yy{}, zz{}, xy{}, xz{}, yz{};
};

struct PrincipalAxes {
  std::array<Lanes, 3> variance;  ///< λ0 ≤ λ1 ≤ λ2, none negative
  std::array<Lanes, 3> normal;    ///< x, y, z of the unit vector that belongs to λ0
};

/// Jacobi's rotations on eight matrices side by side: with a general solver's call for each, a
/// third of the search for surfaces went into it. No branch and no mathematical library, so that
/// every processor rounds alike.
PrincipalAxes principalAxes(const LaneCovariance& covariance);

}  // namespace csom::detail
