// SPDX-License-Identifier: BSD-3-Clause
// Small logs for the tests of csom::rawlog and of the program.
#pragma once

#include <csom/io/MapFile.h>
#include <csom/rawlog/RawlogReader.h>
#include <csom/rawlog/RawlogWriter.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <string>
#include <vector>

#include "io/IoFixtures.h"

namespace csom::test {

using Entries = std::vector<mrpt::serialization::CSerializable::Ptr>;

/// A wall of class 1 two metres ahead, 1 m to each side, and a floor of class 2.
inline mrpt::obs::CObservationPointCloud::Ptr wallCloud(double time) {
  auto cloud = mrpt::maps::CPointsMapXYZI::Create();
  const auto add = [&](float x, float y, float z, float label) {
    const std::size_t at = cloud->size();
    cloud->resize(at + 1);
    cloud->setPointFast(at, x, y, z);
    cloud->setPointIntensity(at, label);
  };
  for (int i = -5; i <= 5; ++i) {
    for (int j = 0; j <= 5; ++j) {
      const float side = 0.2f * static_cast<float>(i);
      add(2.0f, side, 0.3f * static_cast<float>(j), 1.0f);
      add(0.35f * static_cast<float>(j), side, -0.5f, 2.0f);
    }
  }
  auto observation = mrpt::obs::CObservationPointCloud::Create();
  observation->pointcloud = cloud;
  observation->sensorLabel = "lidar";
  observation->timestamp = mrpt::Clock::fromDouble(time);
  return observation;
}

inline mrpt::obs::CObservationRobotPose::Ptr robotPose(double time,
                                                       const mrpt::poses::CPose3D& pose,
                                                       const std::string& label = "truth") {
  auto observation = mrpt::obs::CObservationRobotPose::Create();
  observation->pose.mean = pose;
  observation->sensorLabel = label;
  observation->timestamp = mrpt::Clock::fromDouble(time);
  return observation;
}

inline mrpt::obs::CObservationOdometry::Ptr odometry(double time, double x, double y, double phi) {
  auto observation = mrpt::obs::CObservationOdometry::Create();
  observation->odometry = mrpt::poses::CPose2D(x, y, phi);
  observation->sensorLabel = "wheels";
  observation->timestamp = mrpt::Clock::fromDouble(time);
  return observation;
}

inline mrpt::obs::CActionCollection::Ptr movement(double x, double y, double phi) {
  mrpt::obs::CActionRobotMovement2D action;
  action.computeFromOdometry(mrpt::poses::CPose2D(x, y, phi), {});
  auto collection = mrpt::obs::CActionCollection::Create();
  collection->insert(action);
  return collection;
}

inline mrpt::obs::CSensoryFrame::Ptr frameOf(
    const std::vector<mrpt::obs::CObservation::Ptr>& observations) {
  auto frame = mrpt::obs::CSensoryFrame::Create();
  for (const auto& observation : observations) frame->insert(observation);
  return frame;
}

/// A drive past walls: `scans` robot poses and clouds, one second and half a metre apart.
inline Entries driveEntries(int scans) {
  Entries entries;
  for (int i = 0; i < scans; ++i) {
    entries.push_back(robotPose(100.0 + i, {0.5 * i, 0.1 * i, 0.0, 0.05 * i, 0.01 * i, -0.02 * i}));
    entries.push_back(wallCloud(100.0 + i));
  }
  return entries;
}

inline std::string writeLog(const std::string& file, const Entries& entries) {
  RawlogWriter writer(file);
  for (const auto& entry : entries) writer.write(*entry);
  writer.commit();
  return file;
}

/// Not compressed, so that a byte of the file is a byte of the stream.
inline std::string writePlainLog(const std::string& file, const Entries& entries) {
  mrpt::io::CFileOutputStream stream(file);
  auto archive = mrpt::serialization::archiveFrom(stream);
  for (const auto& entry : entries) archive << *entry;
  return file;
}

/// An ini with a label set of three classes beside it (free, wall, floor) and these further keys in
/// the section of insertion options.
inline std::string writeConfig(const TempFolder& folder, const std::string& keys = "") {
  writeBytes(folder / "labels.yaml",
             "name: walls\nclasses:\n"
             "  - {id: 0, name: free, color: [255, 255, 255]}\n"
             "  - {id: 1, name: wall, color: [200, 0, 0]}\n"
             "  - {id: 2, name: floor, color: [0, 0, 200]}\n");
  const std::string file = folder / "map.ini";
  const bool given = keys.find("point_labels") != std::string::npos;
  const std::string own_labels = given ? "" : "point_labels = intensity\n";
  const std::string section = "[MappingApplication_semanticContinuousMap_00_";
  writeBytes(file, "[MappingApplication]\nsemanticContinuousMap_count = 1\n" + section +
                       "creationOpts]\nlabel_set = labels.yaml\nresolution = 0.2\n" + section +
                       "insertOpts]\n" + own_labels + keys + "\n");
  return file;
}

}  // namespace csom::test
