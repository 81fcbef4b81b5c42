// SPDX-License-Identifier: BSD-3-Clause
// Rotations and poses from the rounded numbers of text files.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

namespace csom::detail {

/// The rotation nearest to `matrix`; nothing if none is within 1 %.
std::optional<Eigen::Matrix3d> nearestRotation(const Eigen::Matrix3d& matrix);

/// The pose of a 3×4 matrix; nothing if its left part is no rotation or any number is not finite.
std::optional<Eigen::Isometry3d> poseFromMatrix(const Eigen::Matrix<double, 3, 4>& matrix);

}  // namespace csom::detail
