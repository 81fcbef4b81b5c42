// SPDX-License-Identifier: BSD-3-Clause
// Small observations of every kind that the map takes.
#pragma once

#include <csom/io/LabelSet.h>
#include <csom/maps/CSemanticContinuousMap.h>
#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <Eigen/Core>
#include <vector>

namespace csom::sample {

/// Free, road, wall and unlabelled; raw 40 is road, 50 wall, 0 ignored.
inline LabelSet sampleLabels() {
  return LabelSet::fromYaml(R"(
name: sample
classes:
  - {id: 0, name: free, color: [255, 255, 255]}
  - {id: 1, name: road, color: [128, 64, 128]}
  - {id: 2, name: wall, color: [0, 200, 0]}
  - {id: 3, name: unlabelled, color: [90, 90, 90]}
raw:
  0: ignore
  40: 1
  50: 2
)",
                            "sample labels");
}

inline mrpt::obs::CObservationPointCloud::Ptr pointCloud(const std::vector<Eigen::Vector3f>& points,
                                                         const std::vector<float>& intensities) {
  auto cloud = mrpt::maps::CPointsMapXYZI::Create();
  cloud->resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    cloud->setPointFast(i, points[i].x(), points[i].y(), points[i].z());
    cloud->setPointIntensity(i, intensities[i]);
  }
  auto observation = mrpt::obs::CObservationPointCloud::Create();
  observation->pointcloud = cloud;
  observation->sensorLabel = "cloud";
  observation->timestamp = mrpt::Clock::fromDouble(1500000000.25);
  return observation;
}

/// Walls of a room of 6 x 4 x 2 m around the sensor, a point every `step` metres.
inline std::vector<Eigen::Vector3f> roomPoints(float step = 0.1f) {
  std::vector<Eigen::Vector3f> points;
  for (float z = -1.0f; z < 1.0f; z += step) {
    for (float x = -3.0f; x < 3.0f; x += step) {
      points.emplace_back(x, -2.0f, z);
      points.emplace_back(x, 2.0f, z);
    }
    for (float y = -2.0f; y < 2.0f; y += step) {
      points.emplace_back(-3.0f, y, z);
      points.emplace_back(3.0f, y, z);
    }
  }
  return points;
}

inline mrpt::obs::CObservationPointCloud::Ptr roomCloud(float step = 0.1f) {
  const std::vector<Eigen::Vector3f> points = roomPoints(step);
  return pointCloud(points, std::vector<float>(points.size(), 50.0f));
}

inline CSemanticContinuousMap sampleMap(double resolution = 0.2) {
  Options options;
  options.resolution = resolution;
  options.method = Method::SeeCsom;  // the walls of the room lie on borders of voxels
  CSemanticContinuousMap map(options, sampleLabels());
  map.insertionOptions.point_labels = PointLabels::ByIntensity;
  return map;
}

inline CSemanticContinuousMap roomMap() {
  CSemanticContinuousMap map = sampleMap();
  map.insertObservation(*roomCloud());
  return map;
}

/// What a scanner of one row sees from the middle of a round room; raw ids as intensities.
inline mrpt::obs::CObservationRotatingScan::Ptr rotatingScan(double range = 3.0) {
  auto observation = mrpt::obs::CObservationRotatingScan::Create();
  observation->sensorLabel = "ring";
  observation->rowCount = 1;
  observation->columnCount = 360;
  observation->rangeResolution = 0.01;
  observation->startAzimuth = -M_PI;
  observation->azimuthSpan = 2 * M_PI;
  observation->rangeImage.setZero(1, 360);
  observation->rangeImage.fill(static_cast<std::uint16_t>(range / 0.01));
  observation->intensityImage.setZero(1, 360);
  observation->intensityImage.fill(50);
  return observation;
}

/// The room as a Velodyne scan without packets.
inline mrpt::obs::CObservationVelodyneScan::Ptr velodyneRoom() {
  auto scan = mrpt::obs::CObservationVelodyneScan::Create();
  scan->sensorLabel = "velodyne";
  for (const Eigen::Vector3f& p : roomPoints()) {
    scan->point_cloud.x.push_back(p.x());
    scan->point_cloud.y.push_back(p.y());
    scan->point_cloud.z.push_back(p.z());
    scan->point_cloud.intensity.push_back(50);
  }
  return scan;
}

/// A wall at 2 m depth seen by a camera of 8 x 6 pixels.
inline mrpt::obs::CObservation3DRangeScan::Ptr rangeCamera() {
  auto observation = mrpt::obs::CObservation3DRangeScan::Create();
  observation->sensorLabel = "camera";
  observation->hasRangeImage = true;
  observation->rangeImage_setSize(6, 8);
  observation->rangeUnits = 0.001f;
  observation->range_is_depth = true;
  observation->rangeImage.fill(2000);
  observation->cameraParams.ncols = 8;
  observation->cameraParams.nrows = 6;
  observation->cameraParams.setIntrinsicParamsFromValues(8.0, 8.0, 3.5, 2.5);
  return observation;
}

inline mrpt::obs::CObservation2DRangeScan::Ptr laserScan(std::size_t rays = 181,
                                                         float range = 5.0f) {
  auto observation = mrpt::obs::CObservation2DRangeScan::Create();
  observation->aperture = static_cast<float>(M_PI);
  observation->maxRange = 20.0f;
  observation->resizeScanAndAssign(rays, range, true);
  return observation;
}

}  // namespace csom::sample
