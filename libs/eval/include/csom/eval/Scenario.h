// SPDX-License-Identifier: BSD-3-Clause
// A world file: a world, the robot that drives through it, and what it senses.
#pragma once

#include <csom/eval/RobotPath.h>
#include <csom/eval/World.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace csom {

/// Where and how often a sensor works. The pose is that of its body (x forward, y left, z up) on
/// the robot: metres, radians, applied as yaw, pitch, roll.
struct SensorMount {
  std::string label;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double yaw = 0;
  double pitch = 0;
  double roll = 0;
  double rate = 1;  ///< observations per second

  Eigen::Isometry3d pose() const;
};

/// Ranges that a sensor reports, and their Gaussian noise [m].
struct RangeModel {
  double min = 0;
  double max = 100;
  double sigma = 0;
};

/// A Velodyne VLP-16 that turns once in 0.1 s; each observation is one turn.
struct VelodyneModel {
  /// What the intensity byte carries: the id of the class hit, or a reflectivity (0 … 255) that
  /// follows from the colour and the angle of incidence.
  enum class Intensity { Class, Reflectivity };
  /// Instantaneous: the whole turn is seen from where it began. Moving: from where the robot is at
  /// each firing.
  enum class Sweep { Instantaneous, Moving };

  SensorMount mount;
  RangeModel range;
  Intensity intensity = Intensity::Class;
  Sweep sweep = Sweep::Instantaneous;
};

/// A pinhole camera without distortion: an RGB image and an image of class ids (0 where nothing is
/// hit) per observation.
struct CameraModel {
  SensorMount mount;
  int width = 320;
  int height = 240;
  double horizontal_fov = 1.5707963267948966;  ///< [rad]
  double max_range = 100;                      ///< [m]

  /// Focal length in pixels, the same along both axes.
  double focalLength() const;
};

/// A sensor that looks along random directions and reports labelled points: azimuth uniform, the
/// sine of the elevation uniform between its limits.
struct PointSamplerModel {
  SensorMount mount;
  RangeModel range;
  int points = 1000;  ///< hits per observation
  double min_elevation = -1.5707963267948966;
  double max_elevation = 1.5707963267948966;
};

using SensorModel = std::variant<VelodyneModel, CameraModel, PointSamplerModel>;
const SensorMount& mountOf(const SensorModel& sensor);

/// Standard deviations of the odometry's error, those of MRPT's Gaussian motion model: an increment
/// of d metres and a degrees has errors of `translation_per_metre`·d + `translation_per_degree`·a
/// metres in x and in y, and of `rotation_per_metre`·d + `rotation_per_degree`·a in heading.
struct OdometryNoise {
  double translation_per_metre = 0;   ///< [m/m]
  double translation_per_degree = 0;  ///< [m/deg]
  double rotation_per_metre = 0;      ///< [deg/m]
  double rotation_per_degree = 0;     ///< [deg/deg]
};

/// Which voxel truth is written.
struct TruthRegion {
  double resolution = 0.1;     ///< [m]
  Eigen::AlignedBox3d region;  ///< voxels with their centre in here
};

struct Scenario {
  std::string file;  ///< where it came from, for messages
  World world;
  RobotPath path;
  std::vector<SensorModel> sensors;
  OdometryNoise odometry;
  TruthRegion truth;
  std::uint64_t seed = 1;
};

/// Reads a world file (docs/simulator.md). Throws ConfigError if it cannot be read, and
/// naming file and line if what it says is not possible; unknown keys are errors.
Scenario loadScenario(const std::string& file);

}  // namespace csom
