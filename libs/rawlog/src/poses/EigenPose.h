// SPDX-License-Identifier: BSD-3-Clause
// Eigen's rigid motions as MRPT's poses, and back.
#pragma once

#include <mrpt/math/CMatrixFixed.h>
#include <mrpt/poses/CPose3D.h>

#include <Eigen/Geometry>

namespace csom::detail {

inline mrpt::poses::CPose3D toMrpt(const Eigen::Isometry3d& motion) {
  mrpt::math::CMatrixDouble44 matrix;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) matrix(row, column) = motion.matrix()(row, column);
  }
  return mrpt::poses::CPose3D(matrix);
}

inline Eigen::Isometry3d toEigen(const mrpt::poses::CPose3D& pose) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.matrix() = pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen();
  return motion;
}

}  // namespace csom::detail
