// SPDX-License-Identifier: BSD-3-Clause
// A drive of the KITTI raw data becomes a rawlog.
#pragma once

#include <csom/rawlog/Import.h>

#include <string>

namespace csom {

struct KittiRawImport {
  /// Holds velodyne_points/data/*.bin, and image_00 … image_03 (any of them) with data/*.png or
  /// *.jpg. Time stamps come from velodyne_points/timestamps.txt and those of the image folders;
  /// scans without are 0.1 s apart, images without have the time of their scan.
  std::string folder;
  /// Folder of calib_velo_to_cam.txt and calib_cam_to_cam.txt; empty: `folder`/calib, or `folder`,
  /// or the folder above it. Only needed if there are images.
  std::string calibration;
  ScanSelection selection;
  bool embed_images =
      false;  ///< into the rawlog (without loss) instead of copies in RAWLOG_Images/
};

/// Writes, for each frame, the images (CObservationImage, labels "image_00" …, rectified pinhole
/// with its pose on the robot) and the scan (CObservationPointCloud, label "velodyne", intensity =
/// reflectance). The robot's frame is that of the Velodyne. No poses are written: KITTI raw has
/// none. Throws FileError, also if nothing is selected; then no file of its own is left behind.
ImportSummary importKittiRaw(const KittiRawImport& request, const std::string& rawlog,
                             const ImportProgress& progress = {});

}  // namespace csom
