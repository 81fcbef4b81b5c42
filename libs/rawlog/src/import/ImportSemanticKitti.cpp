// SPDX-License-Identifier: BSD-3-Clause
// A sequence of SemanticKITTI (KITTI odometry layout) becomes a rawlog.
#include <csom/core/Error.h>
#include <csom/io/KittiReader.h>
#include <csom/io/TrajectoryFile.h>
#include <csom/rawlog/ImportSemanticKitti.h>
#include <csom/rawlog/RawlogWriter.h>

#include <filesystem>

#include "import/DataSetFiles.h"
#include "logs/FrameNumbers.h"
#include "logs/LoggedScan.h"
#include "poses/EigenPose.h"

namespace csom {
namespace {

namespace fs = std::filesystem;

constexpr char kLabel[] = "velodyne";  ///< of the sensor

class Sequence {
 public:
  explicit Sequence(const SemanticKittiImport& request)
      : folder_(request.folder),
        files_(detail::filesIn((folder_ / "velodyne").string(), ".bin")),
        numbers_(detail::numbersOfFiles(files_)),
        poses_file_((folder_ / "poses.txt").string()),
        camera_poses_(readKittiPoses(poses_file_)),
        camera_from_velodyne_(readKittiOdometryCalibration((folder_ / "calib.txt").string())),
        times_((folder_ / "times.txt").string()) {
    if (request.world == SemanticKittiWorld::Velodyne)
      world_from_camera_world_ = camera_from_velodyne_.inverse();
    if (request.labels.empty()) return;
    labels_ = folder_ / request.labels;
    if (!fs::is_directory(labels_)) labels_ = request.labels;
    if (!fs::is_directory(labels_))
      throw FileError((folder_ / request.labels).string(), "no such folder of labels");
  }

  std::size_t size() const { return files_.size(); }
  const std::string& file(std::size_t position) const { return files_[position]; }
  std::size_t number(std::size_t position) const { return numbers_[position]; }
  double time(std::size_t position) const {
    return times_.of(numbers_[position], files_[position]);
  }
  /// False if the line of its pose is blank. Throws FileError if there is no such line.
  bool hasPose(std::size_t position) const {
    if (numbers_[position] >= camera_poses_.size())
      throw FileError(poses_file_, "has " + std::to_string(camera_poses_.size()) +
                                       " poses, so none for " + files_[position]);
    return camera_poses_[numbers_[position]].has_value();
  }
  std::string whereLabelsComeFrom() const {
    return labels_.empty() ? "none; points carry their reflectance, which is no label"
                           : labels_.string() + "/*.label";
  }

  /// Requires hasPose(position).
  std::size_t write(std::size_t position, RawlogWriter& log) const {
    const std::string& file = files_[position];
    const KittiScan scan = readKittiScan(file);
    const Eigen::Isometry3d& camera = *camera_poses_[numbers_[position]];
    const auto velodyne = detail::toMrpt(world_from_camera_world_ * camera * camera_from_velodyne_);
    log.write(detail::poseObservation(velodyne, time(position)));
    log.write(detail::cloudObservation(scan.points, carried(file, scan), time(position), kLabel));
    return scan.points.size();
  }

 private:
  std::vector<float> carried(const std::string& file, const KittiScan& scan) const {
    if (labels_.empty()) return scan.intensities;
    const fs::path labels = labels_ / (fs::path(file).stem().string() + ".label");
    return detail::labelsAsIntensities(readKittiLabels(labels.string(), scan.points.size()));
  }

  fs::path folder_;
  std::vector<std::string> files_;
  std::vector<std::size_t> numbers_;  ///< frames of the files
  std::string poses_file_;
  std::vector<std::optional<Eigen::Isometry3d>> camera_poses_;
  Eigen::Isometry3d camera_from_velodyne_;
  Eigen::Isometry3d world_from_camera_world_ = Eigen::Isometry3d::Identity();
  detail::FrameTimes times_;
  fs::path labels_;
};

/// Those of the chosen scans that have a pose; the others are reported.
std::vector<std::size_t> withPoses(const Sequence& sequence, const std::vector<std::size_t>& chosen,
                                   ImportSummary& summary) {
  std::vector<std::size_t> with_pose;
  std::string first;
  for (const std::size_t position : chosen) {
    if (sequence.hasPose(position))
      with_pose.push_back(position);
    else if (first.empty())
      first = sequence.file(position);
  }
  if (!first.empty())
    summary.warnings.push_back("left out " + std::to_string(chosen.size() - with_pose.size()) +
                               " scans whose line in poses.txt is blank; the first one is " +
                               first);
  return with_pose;
}

}  // namespace

ImportSummary importSemanticKitti(const SemanticKittiImport& request, const std::string& rawlog,
                                  const ImportProgress& progress) {
  const Sequence sequence(request);
  const auto chosen = detail::choose(request.selection, request.folder, sequence.size());
  ImportSummary summary;
  summary.labels = sequence.whereLabelsComeFrom();
  const auto usable = withPoses(sequence, chosen, summary);
  detail::FrameNumbers frames;
  for (const std::size_t position : usable)
    frames.add(kLabel, sequence.time(position), sequence.number(position));
  RawlogWriter log(rawlog);
  log.write(frames.toComment());
  for (const std::size_t position : usable) {
    summary.points += sequence.write(position, log);
    ++summary.scans;
    if (progress) progress(summary.scans, usable.size());
  }
  log.commit();
  return summary;
}

}  // namespace csom
