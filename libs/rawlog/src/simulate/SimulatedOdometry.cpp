// SPDX-License-Identifier: BSD-3-Clause
// Increments of odometry and their errors.
#include "simulate/SimulatedOdometry.h"

#include <mrpt/core/bits_math.h>

#include <cmath>

namespace csom::detail {
namespace {

using mrpt::poses::CPose2D;

/// To 1 µm and 0.1 µrad: the last bits of sines differ between processors.
CPose2D rounded(double x, double y, double phi) {
  return {std::round(x * 1e6) * 1e-6, std::round(y * 1e6) * 1e-6, std::round(phi * 1e7) * 1e-7};
}

}  // namespace

SimulatedOdometry::SimulatedOdometry(const OdometryNoise& noise, const PlanarPose& start,
                                     const Random& random)
    : noise_(noise), last_(start.x, start.y, start.yaw), random_(random) {}

CPose2D SimulatedOdometry::move(const PlanarPose& pose) {
  const CPose2D next(pose.x, pose.y, pose.yaw);
  const CPose2D step = next - last_;
  last_ = next;
  const double metres = step.norm();
  const double degrees = mrpt::RAD2DEG(std::abs(step.phi()));
  const double sigma_xy =
      noise_.translation_per_metre * metres + noise_.translation_per_degree * degrees;
  const double sigma_phi =
      mrpt::DEG2RAD(noise_.rotation_per_metre * metres + noise_.rotation_per_degree * degrees);
  // One statement each: the order in which arguments are evaluated is open.
  const double x = step.x() + sigma_xy * random_.gaussian();
  const double y = step.y() + sigma_xy * random_.gaussian();
  const double phi = step.phi() + sigma_phi * random_.gaussian();
  const CPose2D increment = rounded(x, y, phi);
  reading_ = reading_ + increment;
  return increment;
}

mrpt::obs::CActionRobotMovement2D::TMotionModelOptions SimulatedOdometry::motionModel() const {
  mrpt::obs::CActionRobotMovement2D::TMotionModelOptions options;
  options.modelSelection = mrpt::obs::CActionRobotMovement2D::mmGaussian;
  options.gaussianModel.a1 = noise_.translation_per_metre;
  options.gaussianModel.a2 = mrpt::RAD2DEG(noise_.translation_per_degree);
  options.gaussianModel.a3 = mrpt::DEG2RAD(noise_.rotation_per_metre);
  options.gaussianModel.a4 = noise_.rotation_per_degree;
  options.gaussianModel.minStdXY = 0.001;
  options.gaussianModel.minStdPHI = mrpt::DEG2RAD(0.01);
  return options;
}

}  // namespace csom::detail
