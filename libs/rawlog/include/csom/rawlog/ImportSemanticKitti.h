// SPDX-License-Identifier: BSD-3-Clause
// A sequence of SemanticKITTI (KITTI odometry layout) becomes a rawlog.
#pragma once

#include <csom/rawlog/Import.h>

#include <string>

namespace csom {

/// The frame that poses are written in.
enum class SemanticKittiWorld {
  Velodyne,  ///< Tr⁻¹ · pose · Tr: x forward and z up where the sequence starts
  Camera     ///< pose · Tr: as in poses.txt, z forward and y down
};

struct SemanticKittiImport {
  /// Holds velodyne/*.bin, poses.txt (camera 0 in the world), calib.txt (`Tr`) and, optionally,
  /// times.txt (seconds; without it scans are 0.1 s apart, the first at 0).
  std::string folder;
  /// "labels", "predictions" or any folder of *.label files, inside `folder` or a path; empty:
  /// none.
  std::string labels;
  SemanticKittiWorld world = SemanticKittiWorld::Camera;
  ScanSelection selection;
};

/// Writes, for each scan, a CObservationRobotPose (the Velodyne's pose in the world; sensor label
/// "poses") and a CObservationPointCloud (label "velodyne", sensor frame = robot frame) whose
/// intensity is the raw SemanticKITTI id, or the reflectance if no labels are asked for. File
/// NNNNNN.bin has line NNNNNN of poses.txt. Throws FileError, also if nothing is selected.
ImportSummary importSemanticKitti(const SemanticKittiImport& request, const std::string& rawlog,
                                  const ImportProgress& progress = {});

}  // namespace csom
