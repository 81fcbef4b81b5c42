// SPDX-License-Identifier: BSD-3-Clause
// The scans of a log as every method gets them: labelled, in the map frame.
#pragma once

#include <csom/core/types.h>
#include <csom/maps/LabelOptions.h>
#include <csom/maps/LabelRules.h>
#include <csom/rawlog/PoseSource.h>

#include <string>
#include <vector>

namespace csom {

/// Where labels and poses come from.
struct LogReading {
  PointLabels point_labels = PointLabels::ByIntensity;  ///< if no camera labels the points
  LabelOptions label_options;                           ///< cameras that do
  PoseChoice poses;
};

/// Points of scans as csom map would insert them: poses rounded, Velodyne scans without the robot's
/// motion, labels from the points or from cameras, points without a label left out. Throws
/// FileError and ConfigError as mapLogs() does; FileError if not a single scan has labelled points.
std::vector<Scan> readLoggedScans(const std::string& rawlog, const LabelSet& labels,
                                  const LogReading& reading);

}  // namespace csom
