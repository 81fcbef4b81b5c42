// SPDX-License-Identifier: BSD-3-Clause
// Scans to measure with: SemanticKITTI's, or of the simulated campus.
#pragma once

#include <csom/core/types.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace csom::bench {

/// A labelled scan as the sensor gives it, and where the sensor was.
struct SensorScan {
  std::vector<Eigen::Vector3f> points;  ///< sensor frame [m]
  std::vector<ClassId> labels;
  RangeImage image;  ///< found, as for the scans of a log that does not tell it
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< of the sensor in the map frame
};

/// A short drive. Scans are made anew each time that they are asked for.
struct Drive {
  std::string name;
  std::size_t scans = 0;
  std::function<SensorScan(std::size_t)> scan;
};

/// All maps here have as many classes as SemanticKITTI's label set.
constexpr int kClasses = 20;

/// The five scans of `folder`/semantickitti_08 with predicted labels. Throws FileError.
Drive semanticKitti(const std::string& folder);
/// What a laser of 64 beams with `columns` directions a turn sees from places along the drive
/// through config/worlds/campus.yaml. Throws ConfigError.
Drive campus(std::size_t scans, int columns);

/// Finds the image of a scan's points. Throws std::runtime_error if they are in no rows.
void findImage(SensorScan& scan);

/// SemanticKITTI if the environment variable CSOM_DATA names a folder, else the campus; a small
/// part of the campus if `quick`.
Drive chooseDrive(bool quick);

/// As a map takes it: moved to its pose.
Scan inMap(const SensorScan& scan);
std::vector<Scan> allInMap(const Drive& drive);

/// At least `points` points (exactly so many, unless there are none) of a scene that grows with
/// them: first a sector of `scan`, then whole copies of it side by side.
Scan widerScene(const Scan& scan, std::size_t points);
/// `points` points, evenly picked, of what all scans saw: the same scene, more densely.
Scan denserScene(const std::vector<Scan>& scans, std::size_t points);

}  // namespace csom::bench
