// SPDX-License-Identifier: BSD-3-Clause
// Labelled points in random directions.
#include <csom/core/Error.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <cmath>
#include <string>

#include "simulate/SimulatedSensors.h"

namespace csom::detail {
namespace {

using Eigen::Vector3d;

/// Rays for each point wanted, before the sensor gives up.
constexpr int kMaxRaysPerPoint = 1000;

Vector3d randomDirection(const PointSamplerModel& model, Random& random) {
  constexpr double kPi = 3.14159265358979323846;
  const double azimuth = random.uniform(-kPi, kPi);
  const double z = random.uniform(std::sin(model.min_elevation), std::sin(model.max_elevation));
  const double horizontal = std::sqrt(std::max(0.0, 1 - z * z));
  return {horizontal * std::cos(azimuth), horizontal * std::sin(azimuth), z};
}

}  // namespace

Sensed sense(const PointSamplerModel& model, const World& world, const Moment& moment,
             Random& random) {
  const Eigen::Isometry3d sensor = moment.robot() * model.mount.pose();
  const auto wanted = static_cast<std::size_t>(model.points);
  auto points = mrpt::maps::CPointsMapXYZI::Create();
  points->resize(wanted);
  std::size_t found = 0;
  for (std::size_t ray = 0; found < wanted; ++ray) {
    if (ray == wanted * kMaxRaysPerPoint)
      throw ConfigError("sensor '" + model.mount.label + "' found only " + std::to_string(found) +
                        " of " + std::to_string(wanted) +
                        " points within its range; move it, or lower 'points'");
    const Vector3d direction = randomDirection(model, random);
    const auto hit = world.castRay(sensor.translation(), sensor.linear() * direction,
                                   model.range.max, moment.time);
    if (!hit) continue;
    const double distance = hit->distance + model.range.sigma * random.gaussian();
    if (distance < model.range.min || distance > model.range.max) continue;
    const Eigen::Vector3f point = (distance * direction).cast<float>();
    points->setPointAllFieldsFast(
        found++, {point.x(), point.y(), point.z(), static_cast<float>(hit->class_id)});
  }
  auto observation = mrpt::obs::CObservationPointCloud::Create();
  observation->sensorLabel = model.mount.label;
  observation->timestamp = moment.timestamp;
  observation->sensorPose = toMrpt(model.mount);
  observation->pointcloud = points;
  return {{observation}, found};
}

}  // namespace csom::detail
