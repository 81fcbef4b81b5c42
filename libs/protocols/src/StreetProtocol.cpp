// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/core/FindRangeImage.h>
#include <csom/io/KittiReader.h>
#include <csom/io/TrajectoryFile.h>
#include <csom/protocols/StreetProtocol.h>
#include <csom/rawlog/Import.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

namespace csom {
namespace {

namespace fs = std::filesystem;

class StreetFolder {
 public:
  StreetFolder(const std::string& folder, const LabelSet& labels, bool predictions)
      : folder_(folder),
        predictions_(predictions),
        labels_(labels),
        poses_file_((folder_ / "poses.txt").string()),
        camera_poses_(readKittiPoses(poses_file_)),
        camera_from_velodyne_(readKittiOdometryCalibration((folder_ / "calib.txt").string())) {}

  /// `number`: of the frame, which is the line of its pose.
  StreetScan read(const fs::path& file, std::size_t number) {
    if (number >= camera_poses_.size())
      throw FileError(poses_file_, "has " + std::to_string(camera_poses_.size()) +
                                       " poses, so none for " + file.string());
    if (!camera_poses_[number])
      throw FileError(poses_file_, "line " + std::to_string(number + 1) +
                                       " is blank, so there is no pose for " + file.string());
    const Eigen::Isometry3d pose = *camera_poses_[number] * camera_from_velodyne_;
    StreetScan scan;
    scan.origin = pose.translation();
    const KittiScan seen = readKittiScan(file.string());
    for (const Eigen::Vector3f& point : seen.points)
      scan.points.push_back(pose * point.cast<double>());
    scan.labels = classesOf(file, "labels", scan.points.size());
    if (predictions_) {
      scan.predictions = classesOf(file, "predictions", scan.points.size());
      if (auto image = findRangeImage(seen.points)) scan.image = *std::move(image);
    }
    return scan;
  }

  std::size_t unknownLabels() const { return unknown_; }

 private:
  std::vector<ClassId> classesOf(const fs::path& scan, const char* kind, std::size_t points) {
    const fs::path file = folder_ / kind / (scan.stem().string() + ".label");
    std::vector<ClassId> classes;
    classes.reserve(points);
    for (const std::uint32_t id : readKittiLabels(file.string(), points)) {
      const LabelSet::Raw raw = labels_.classOfRaw(id);
      if (raw.kind == LabelSet::RawKind::Unknown) ++unknown_;
      classes.push_back(raw.kind == LabelSet::RawKind::Class ? raw.id : kFreeClass);
    }
    return classes;
  }

  fs::path folder_;
  bool predictions_;
  const LabelSet& labels_;
  std::string poses_file_;
  std::vector<std::optional<Eigen::Isometry3d>> camera_poses_;
  Eigen::Isometry3d camera_from_velodyne_;
  std::size_t unknown_ = 0;
};

}  // namespace

bool isStreet(const std::string& folder) {
  std::error_code error;
  return fs::is_directory(fs::path(folder) / "velodyne", error);
}

Street readStreet(const std::string& folder, const LabelSet& labels, bool predictions) {
  Street street;
  street.labels = labels;
  StreetFolder reader(folder, labels, predictions);
  const auto files = detail::filesIn((fs::path(folder) / "velodyne").string(), ".bin");
  const auto numbers = detail::numbersOfFiles(files);
  for (std::size_t i = 0; i < files.size(); ++i)
    street.scans.push_back(reader.read(files[i], numbers[i]));
  if (reader.unknownLabels() > 0)
    street.warnings.push_back(folder + ": did not use " + std::to_string(reader.unknownLabels()) +
                              " labels that the label set '" + labels.name() + "' does not know");
  return street;
}

LabelledCloud labelledPoints(const Street& street) {
  LabelledCloud all;
  for (const StreetScan& scan : street.scans) all.append({scan.points, scan.labels});
  return all;
}

namespace {

/// What P3 and P7 have in common: all but which scans are mapped, and the truth.
Trial streetTrial(const Street& street, const std::string& protocol, double density,
                  double resolution) {
  Trial trial;
  trial.protocol = protocol;
  trial.labels = street.labels;
  trial.options.number_of_classes = street.labels.numberOfClasses();
  trial.options.resolution = resolution;
  trial.options.scan.ds_resolution = density;
  trial.options.free_space.mode = FreeSpace::None;
  trial.points = std::make_shared<LabelledCloud>(labelledPoints(street));
  return trial;
}

/// The scans 0, `every`, 2·`every` … as the network labels them.
std::shared_ptr<const std::vector<Scan>> predictedScans(const Street& street, std::size_t every) {
  auto scans = std::make_shared<std::vector<Scan>>();
  for (std::size_t i = 0; i < street.scans.size(); i += every) {
    const StreetScan& scan = street.scans[i];
    scans->push_back(scanOf({scan.points, scan.predictions}, scan.origin, scan.image));
  }
  return scans;
}

}  // namespace

std::vector<Trial> streetTrials(const Street& street, std::size_t every, double density,
                                double resolution) {
  if (every == 0) throw std::invalid_argument("every = 0: must be at least 1");
  Trial trial = streetTrial(street, "P3", density, resolution);
  trial.scans = predictedScans(street, every);
  trial.truth = std::make_shared<VoxelTruth>(
      computeTruth(*trial.points, resolution, trial.options.number_of_classes));
  return {trial};
}

std::vector<Trial> knownStreetTrials(const Street& street, double density, double resolution) {
  Trial trial = streetTrial(street, "P7", density, resolution);
  trial.options.free_space.mode = FreeSpace::Raycast;
  trial.scans = predictedScans(street, std::max<std::size_t>(1, street.scans.size() - 1));
  trial.truth = std::make_shared<VoxelTruth>(computeStreetTruth(street, resolution));
  return {trial};
}

PointScore scoreOfPredictions(const Street& street) {
  PointScore score(street.labels.numberOfClasses());
  for (const StreetScan& scan : street.scans) {
    for (std::size_t i = 0; i < scan.points.size(); ++i)
      if (scan.labels[i] != kFreeClass) score.add(scan.labels[i], scan.predictions[i]);
  }
  return score;
}

}  // namespace csom
