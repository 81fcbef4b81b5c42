// SPDX-License-Identifier: BSD-3-Clause
#include "run/MappingWarnings.h"

#include <csom/core/ScanPreparation.h>
#include <csom/io/TextParser.h>

#include <cstdio>
#include <functional>

namespace csom::detail {
namespace {

using Warn = std::function<void(const std::string&)>;

/// How far a map and a scan reach, and what to do with coordinates of a country's grid.
std::string rangeHint(const Options& options, const Eigen::Vector3d& farthest_pose) {
  const double reach = options.resolution * kMaxVoxelIndex;
  std::string farthest;
  if (farthest_pose.cwiseAbs().maxCoeff() > reach) {
    char place[128];
    std::snprintf(place, sizeof place, "; the robot was at (%.1f, %.1f, %.1f)", farthest_pose.x(),
                  farthest_pose.y(), farthest_pose.z());
    farthest = place;
  }
  char text[320];
  std::snprintf(
      text, sizeof text,
      "; with voxels of %g m a map reaches %.0f km from its origin along each axis, and a "
      "scan %.0f km from its sensor%s. Subtract one offset from all poses (for UTM, the "
      "position of the first one), or take larger voxels",
      options.resolution, reach / 1000, scanReach(options) / 1000, farthest.c_str());
  return text;
}

void warnAboutPoints(const CSemanticContinuousMap& map, const Eigen::Vector3d& farthest_pose,
                     const Warn& warn) {
  const InsertionStatistics& statistics = map.statistics();
  ScanReport sum = statistics.unused;
  for (const ScanRecord& scan : map.scans()) sum += scan.report;
  for (std::size_t i = 0; i < kRejectReasons; ++i) {
    const auto reason = static_cast<RejectReason>(i);
    // A range limit is a wish of the user's, not a fault of the data.
    if (reason == RejectReason::TooNear || reason == RejectReason::TooFar) continue;
    if (sum.rejected[i] == 0) continue;
    warn("rejected " + counted(sum.rejected[i], "points: ") + toString(reason) +
         (reason == RejectReason::OutsideIndexRange ? rangeHint(map.map().options(), farthest_pose)
                                                    : ""));
  }
  const std::string set = "'" + map.labels().name() + "'";
  const LabelCounts& labels = statistics.labels;
  const auto warnAboutUnknown = [&](const char* what, std::size_t count, const char* rest) {
    if (count == 0) return;
    warn(what + counted(count, "points whose label is not in the label set ") + set +
         ", or means free" + rest +
         "; if their intensities are no labels, set point_labels = none");
  };
  warnAboutUnknown("left out ", labels.unknown, "");
  warnAboutUnknown("kept ", labels.kept_unknown, ", as unlabelled");
  if (labels.ambiguous > 0)
    warn("left out " + counted(labels.ambiguous, "points with several labels"));
  if (labels.missing > 0)
    warn("left out " + counted(labels.missing, "points without a label") +
         "; unlabelled_class or scan_2d_class can give them a class, such as unlabelled");
}

/// Cameras that look past nearly all points are probably turned the wrong way.
void warnAboutViews(const CameraStatistics& cameras, const Warn& warn) {
  constexpr double kNearlyAll = 0.98;
  const std::size_t outside = cameras.points.outside_view;
  const std::size_t all = cameras.points.inView() + outside;
  if (cameras.scans.labelled == 0 ||
      static_cast<double>(outside) < kNearlyAll * static_cast<double>(all))
    return;
  std::string text = std::to_string(outside) + " of " + counted(all, "points lie") +
                     " outside of the view of all cameras";
  for (const CameraStatistics::Camera& camera : cameras.cameras) {
    if (camera.images.read == camera.images.refused) continue;
    char axis[96];
    std::snprintf(axis, sizeof axis, "; %s looks along (%.2f, %.2f, %.2f) of the robot",
                  detail::quoted(camera.sensor_label).c_str(), camera.looks_along[0],
                  camera.looks_along[1], camera.looks_along[2]);
    text += axis;
  }
  warn(text +
       " (x ahead, y left, z up). The pose of a camera has z along its view, x to the right "
       "and y down; one with the axes of the robot lacks a turn by yaw -90, roll -90 degrees");
}

void warnAboutCameras(const CSemanticContinuousMap& map, const Warn& warn) {
  const auto cameras = map.cameraStatistics();
  if (!cameras) return;
  for (const CameraStatistics::Camera& camera : cameras->cameras) {
    if (camera.images.read == 0)
      warn("label source " + detail::quoted(camera.sensor_label) + ": no image of it was read");
  }
  if (!cameras->cache_fault.empty())
    warn("what networks said is not kept for later runs from here on: " + cameras->cache_fault);
  warnAboutViews(*cameras, warn);
  if (cameras->scans.without_image > 0)
    warn(counted(cameras->scans.without_image, "scans") +
         " had no image within max_time_offset: their points have no label");
}

}  // namespace

std::string counted(std::size_t count, const std::string& things) {
  return std::to_string(count) + " " + things;
}

std::vector<std::string> warningsAbout(const CSemanticContinuousMap& map,
                                       const Eigen::Vector3d& farthest_pose) {
  std::vector<std::string> warnings;
  const Warn warn = [&](const std::string& text) { warnings.push_back(text); };
  warnAboutPoints(map, farthest_pose, warn);
  warnAboutCameras(map, warn);
  return warnings;
}

std::string whyEmpty(const MappingRequest& request, const MappingResult& result) {
  std::string text = request.logs.front();
  if (request.logs.size() > 1) text += " and " + std::to_string(request.logs.size() - 1) + " more";
  text += ": no observation could be used";
  if (result.observations_read == 0) text += "; it holds none";
  for (const auto& [what, count] : result.refused)
    text += "; " + counted(count, what.first) + ": " + what.second;
  for (const std::string& warning : result.warnings) {
    if (warning.rfind("refused ", 0) != 0) text += "; " + warning;
  }
  return text;
}

}  // namespace csom::detail
