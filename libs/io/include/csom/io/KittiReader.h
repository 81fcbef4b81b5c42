// SPDX-License-Identifier: BSD-3-Clause
// Files of the KITTI family: Velodyne scans, SemanticKITTI labels, calibrations.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace csom {

struct KittiScan {
  std::vector<Eigen::Vector3f> points;  ///< sensor frame [m]
  std::vector<float> intensities;       ///< one a point, 0 … 1
};

/// velodyne/NNNNNN.bin: float32 x y z intensity a point, little-endian. Throws FileError if the
/// size is not a multiple of 16 bytes.
KittiScan readKittiScan(const std::string& file);

/// labels/NNNNNN.label: uint32 a point, little-endian; returns the raw class ids (low 16 bits, the
/// high ones number instances). Throws FileError if there are not exactly `points` of them.
std::vector<std::uint32_t> readKittiLabels(const std::string& file, std::size_t points);

/// calib.txt of the odometry benchmark: its `Tr`, which takes points of the Velodyne to camera 0.
/// Throws FileError.
Eigen::Isometry3d readKittiOdometryCalibration(const std::string& file);

/// One rectified camera of a KITTI raw drive and where it sits on the Velodyne.
struct KittiCamera {
  int width = 0;  ///< pixels of the rectified image
  int height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< rectified pinhole, pixels
  /// Takes points of the Velodyne frame to the rectified camera's own frame (z forward, x right).
  Eigen::Isometry3d camera_from_velodyne = Eigen::Isometry3d::Identity();
};

/// Reads calib_velo_to_cam.txt and calib_cam_to_cam.txt of `folder`; `camera` is 0 … 3. A Velodyne
/// point X projects to fx·x/z + cx, fy·y/z + cy of camera_from_velodyne · X, which equals
/// P_rect · R_rect_00 · T_velo_to_cam · X. Throws FileError.
KittiCamera readKittiRawCamera(const std::string& folder, int camera);

}  // namespace csom
