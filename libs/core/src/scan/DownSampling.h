// SPDX-License-Identifier: BSD-3-Clause
// One training point a cell.
#pragma once

#include <csom/core/Options.h>

#include <Eigen/Core>

#include "scan/PointSet.h"

namespace csom::detail {

/// One point a cell of options.scan.ds_resolution, at the centroid, with the majority class (ties:
/// the lower id) or mean scores; cells in z-major order. All points if ds_resolution is 0.
PointSet downSample(PointSet in, const Eigen::Vector3d& origin, const Options& options);

}  // namespace csom::detail
