// SPDX-License-Identifier: BSD-3-Clause
// A sequence of SemanticKITTI (KITTI odometry layout) becomes a rawlog.
#include <csom/core/Error.h>
#include <csom/io/KittiReader.h>
#include <csom/io/TrajectoryFile.h>
#include <csom/rawlog/ImportSemanticKitti.h>
#include <csom/rawlog/RawlogWriter.h>

#include <filesystem>

#include "DataSetFiles.h"
#include "EigenPose.h"
#include "LoggedScan.h"

namespace csom {
namespace {

namespace fs = std::filesystem;

class Sequence {
 public:
  explicit Sequence(const SemanticKittiImport& request)
      : folder_(request.folder),
        files_(detail::filesIn((folder_ / "velodyne").string(), ".bin")),
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

  std::size_t write(std::size_t position, RawlogWriter& log) const {
    const std::string& file = files_[position];
    const std::size_t number = detail::numberOfFile(file).value_or(position);
    const double time = times_.of(number, file);
    const KittiScan scan = readKittiScan(file);
    log.write(detail::poseObservation(velodynePose(file, number), time));
    log.write(detail::cloudObservation(scan.points, carried(file, scan), time, "velodyne"));
    return scan.points.size();
  }

 private:
  mrpt::poses::CPose3D velodynePose(const std::string& file, std::size_t number) const {
    if (number >= camera_poses_.size())
      throw FileError(poses_file_, "has " + std::to_string(camera_poses_.size()) +
                                       " poses, so none for " + file);
    return detail::toMrpt(world_from_camera_world_ * camera_poses_[number] * camera_from_velodyne_);
  }

  std::vector<float> carried(const std::string& file, const KittiScan& scan) const {
    if (labels_.empty()) return scan.intensities;
    const fs::path labels = labels_ / (fs::path(file).stem().string() + ".label");
    return detail::labelsAsIntensities(readKittiLabels(labels.string(), scan.points.size()));
  }

  fs::path folder_;
  std::vector<std::string> files_;
  std::string poses_file_;
  std::vector<Eigen::Isometry3d> camera_poses_;
  Eigen::Isometry3d camera_from_velodyne_;
  Eigen::Isometry3d world_from_camera_world_ = Eigen::Isometry3d::Identity();
  detail::ScanTimes times_;
  fs::path labels_;
};

}  // namespace

ImportSummary importSemanticKitti(const SemanticKittiImport& request, const std::string& rawlog,
                                  const ImportProgress& progress) {
  const Sequence sequence(request);
  const auto chosen = detail::choose(request.selection, request.folder, sequence.size());
  RawlogWriter log(rawlog);
  ImportSummary summary;
  for (const std::size_t position : chosen) {
    summary.points += sequence.write(position, log);
    ++summary.scans;
    if (progress) progress(summary.scans, chosen.size());
  }
  log.commit();
  return summary;
}

}  // namespace csom
