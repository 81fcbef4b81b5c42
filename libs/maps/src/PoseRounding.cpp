// SPDX-License-Identifier: BSD-3-Clause
// Robot poses on a lattice.
#include <csom/maps/PoseRounding.h>
#include <mrpt/math/CMatrixFixed.h>

#include <array>
#include <cmath>
#include <stdexcept>

namespace csom {
namespace {

constexpr double kTranslationStep = 1.0 / (1 << 20);  // [m]
constexpr double kQuaternionStep = 1.0 / (1 << 30);
constexpr double kMaxTranslation = 4398046511104.0;  // 2⁴² m: steps stay exact in a double

using Quaternion = std::array<double, 4>;  // w, x, y, z

Eigen::Matrix3d rotationOf(const mrpt::poses::CPose3D& pose) {
  const mrpt::math::CMatrixDouble33& r = pose.getRotationMatrix();
  Eigen::Matrix3d out;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) out(row, column) = r(row, column);
  }
  return out;
}

/// Divides by the component of largest magnitude only, so that no bits are lost near half turns.
Quaternion toQuaternion(const Eigen::Matrix3d& r) {
  const double trace = r.trace();
  const std::array<double, 4> squares{1 + trace, 1 + 2 * r(0, 0) - trace, 1 + 2 * r(1, 1) - trace,
                                      1 + 2 * r(2, 2) - trace};  // 4 w², 4 x², 4 y², 4 z²
  std::size_t largest = 0;
  for (std::size_t i = 1; i < 4; ++i) {
    if (squares[i] > squares[largest]) largest = i;
  }
  const double twice = std::sqrt(squares[largest]);
  const double f = 0.5 / twice;
  Quaternion q{};
  switch (largest) {
    case 0:
      q = {0, r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1)};
      break;
    case 1:
      q = {r(2, 1) - r(1, 2), 0, r(1, 0) + r(0, 1), r(0, 2) + r(2, 0)};
      break;
    case 2:
      q = {r(0, 2) - r(2, 0), r(1, 0) + r(0, 1), 0, r(2, 1) + r(1, 2)};
      break;
    default:
      q = {r(1, 0) - r(0, 1), r(0, 2) + r(2, 0), r(2, 1) + r(1, 2), 0};
      break;
  }
  for (double& component : q) component *= f;
  q[largest] = 0.5 * twice;
  return q;
}

/// q and −q are the same rotation: the first component that is not 0 after rounding is made
/// positive. Components stay whole numbers of steps, without a division by the norm.
Quaternion onLattice(Quaternion q) {
  for (double& component : q) component = std::nearbyint(component / kQuaternionStep);
  double sign = 1;
  for (const double component : q) {
    if (component == 0) continue;
    sign = component < 0 ? -1 : 1;
    break;
  }
  for (double& component : q) component *= sign;
  return q;
}

/// The rotation of a quaternion of any norm.
Eigen::Matrix3d rotationOf(const Quaternion& q) {
  const auto [w, x, y, z] = q;
  const double s = 2 / (w * w + x * x + y * y + z * z);
  Eigen::Matrix3d r;
  r << 1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),  //
      s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x),   //
      s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y);
  return r;
}

double onLattice(double coordinate) {
  // Adding 0 turns −0 into +0.
  return std::nearbyint(coordinate / kTranslationStep) * kTranslationStep + 0.0;
}

}  // namespace

Eigen::Isometry3d roundedPose(const mrpt::poses::CPose3D& pose) {
  const Eigen::Vector3d translation(pose.x(), pose.y(), pose.z());
  const Eigen::Matrix3d rotation = rotationOf(pose);
  if (!translation.allFinite() || !rotation.allFinite() ||
      translation.cwiseAbs().maxCoeff() > kMaxTranslation)
    throw std::runtime_error("robot pose is not finite: " + pose.asString());
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = rotationOf(onLattice(toQuaternion(rotation)));
  out.translation() << onLattice(translation.x()), onLattice(translation.y()),
      onLattice(translation.z());
  return out;
}

Eigen::Isometry3d sensorPoseInMap(const Eigen::Isometry3d& robot,
                                  const mrpt::poses::CPose3D& sensor) {
  Eigen::Isometry3d on_robot = Eigen::Isometry3d::Identity();
  on_robot.linear() = rotationOf(sensor);
  on_robot.translation() << sensor.x(), sensor.y(), sensor.z();
  return robot * on_robot;
}

}  // namespace csom
