// SPDX-License-Identifier: BSD-3-Clause
#include "RigidTransform.h"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace csom::detail {

std::optional<Eigen::Matrix3d> nearestRotation(const Eigen::Matrix3d& matrix) {
  constexpr double tolerance = 0.01;
  if (!matrix.allFinite() || matrix.determinant() <= 0) return std::nullopt;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
  if ((rotation - matrix).cwiseAbs().maxCoeff() > tolerance) return std::nullopt;
  return rotation;
}

std::optional<Eigen::Isometry3d> poseFromMatrix(const Eigen::Matrix<double, 3, 4>& matrix) {
  const auto rotation = nearestRotation(matrix.leftCols<3>());
  if (!rotation || !matrix.allFinite()) return std::nullopt;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = *rotation;
  pose.translation() = matrix.col(3);
  return pose;
}

}  // namespace csom::detail
