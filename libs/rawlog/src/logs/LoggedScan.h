// SPDX-License-Identifier: BSD-3-Clause
// A scan and its pose as observations of MRPT.
#pragma once

#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/poses/CPose3D.h>

#include <Eigen/Core>
#include <string>
#include <vector>

namespace csom::detail {

/// `carried[i]`, a label or a reflectance, becomes the intensity of point i; empty: the points have
/// none, so that nobody takes it for a label.
mrpt::obs::CObservationPointCloud cloudObservation(const std::vector<Eigen::Vector3f>& points,
                                                   const std::vector<float>& carried, double time,
                                                   const std::string& sensor_label);

mrpt::obs::CObservationRobotPose poseObservation(const mrpt::poses::CPose3D& pose, double time);

/// A float holds whole numbers only up to here.
constexpr std::uint32_t kLargestLabelInFloat = 1u << 24;

/// Labels as intensities; those that a float cannot hold become 2³², which no label set knows.
std::vector<float> labelsAsIntensities(const std::vector<std::uint32_t>& labels);

}  // namespace csom::detail
