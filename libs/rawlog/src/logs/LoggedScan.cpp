// SPDX-License-Identifier: BSD-3-Clause
// A scan and its pose as observations of MRPT.
#include "logs/LoggedScan.h"

#include <mrpt/core/Clock.h>
#include <mrpt/maps/CSimplePointsMap.h>

namespace csom::detail {

mrpt::obs::CObservationPointCloud cloudObservation(const std::vector<Eigen::Vector3f>& points,
                                                   const std::vector<float>& carried, double time,
                                                   const std::string& sensor_label) {
  const auto with_intensities = mrpt::maps::CPointsMapXYZI::Create();
  mrpt::maps::CPointsMap::Ptr cloud = with_intensities;
  if (carried.empty()) cloud = mrpt::maps::CSimplePointsMap::Create();
  cloud->resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    cloud->setPointFast(i, points[i].x(), points[i].y(), points[i].z());
    if (!carried.empty()) with_intensities->setPointIntensity(i, carried[i]);
  }
  mrpt::obs::CObservationPointCloud observation;
  observation.pointcloud = cloud;
  observation.timestamp = mrpt::Clock::fromDouble(time);
  observation.sensorLabel = sensor_label;
  return observation;
}

mrpt::obs::CObservationRobotPose poseObservation(const mrpt::poses::CPose3D& pose, double time) {
  mrpt::obs::CObservationRobotPose observation;
  observation.pose.mean = pose;
  observation.timestamp = mrpt::Clock::fromDouble(time);
  observation.sensorLabel = "poses";
  return observation;
}

std::vector<float> labelsAsIntensities(const std::vector<std::uint32_t>& labels) {
  constexpr float kNoLabel = 4294967296.0f;
  std::vector<float> intensities;
  intensities.reserve(labels.size());
  for (const std::uint32_t label : labels)
    intensities.push_back(label <= kLargestLabelInFloat ? static_cast<float>(label) : kNoLabel);
  return intensities;
}

}  // namespace csom::detail
