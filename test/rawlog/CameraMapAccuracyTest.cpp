// SPDX-License-Identifier: BSD-3-Clause
// A map that is made from a network's labels is at least as right as these labels are.
#include <csom/maps/CSemanticContinuousMap.h>
#include <csom/maps/PointExtractor.h>
#include <csom/maps/PoseRounding.h>
#include <csom/rawlog/RawlogReader.h>
#include <gmock/gmock.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <iostream>
#include <vector>

namespace csom {
namespace {

/// A point that the camera labelled, and what it really lies on.
struct JudgedPoint {
  Eigen::Vector3d in_map;
  ClassId truth;
  ClassId network;
};

class CampusDrive {
 public:
  CampusDrive()
      : map_(CSemanticContinuousMap::definitionFromIni(CSOM_SOURCE_DIR
                                                       "/config/campus-camera.ini")) {
    map_.setLabelledScanObserver([this](const LabelledScan& scan) { judge(scan); });
    RawlogReader reader(CSOM_SOURCE_DIR "/rawlogs/campus.rawlog");
    while (const auto entry = reader.next()) insert(*entry);
    map_.flush();
  }

  const CSemanticContinuousMap& map() const { return map_; }
  const std::vector<JudgedPoint>& points() const { return points_; }

 private:
  struct Taken {
    std::vector<PointLabel> truth;
    Eigen::Isometry3d sensor_in_map;
  };

  void insert(const RawlogEntry& entry) {
    for (const auto& observation : entry.observations) {
      if (const auto* robot =
              dynamic_cast<const mrpt::obs::CObservationRobotPose*>(observation.get()))
        pose_ = robot->pose.mean;
    }
    for (const auto& observation : entry.observations) {
      if (const auto* scan =
              dynamic_cast<const mrpt::obs::CObservationVelodyneScan*>(observation.get())) {
        // The simulated intensity is the class of what was hit; the map does not look at it.
        const LabelRules rules(map_.labels(), PointLabels::ByIntensity, "drop", "drop");
        const SensorPoints points = findPointExtractor(*scan)->extract(*scan, rules);
        taken_.push_back({points.labels, sensorPoseInMap(roundedPose(pose_), points.sensor_pose)});
      }
      map_.insertObservation(*observation, pose_);
    }
  }

  void judge(const LabelledScan& scan) {
    const Taken& taken = taken_.at(judged_++);
    ASSERT_EQ(scan.points.size(), taken.truth.size());
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      if (scan.labelled.fates[i] != PointFate::Labelled) continue;
      points_.push_back({taken.sensor_in_map * scan.points[i].cast<double>(), taken.truth[i].id,
                         scan.labelled.classes[i]});
    }
  }

  CSemanticContinuousMap map_;
  mrpt::poses::CPose3D pose_;
  std::vector<Taken> taken_;
  std::size_t judged_ = 0;
  std::vector<JudgedPoint> points_;
};

TEST(CameraMapAccuracy, IsAtLeastThatOfTheNetworkOnTheSamePixels) {
  const CampusDrive drive;
  std::size_t network_right = 0;
  std::size_t map_right = 0;
  for (const JudgedPoint& point : drive.points()) {
    network_right += point.network == point.truth ? 1 : 0;
    map_right += drive.map().map().at(point.in_map).surfaceClass() == point.truth ? 1 : 0;
  }
  const auto count = static_cast<double>(drive.points().size());
  ASSERT_GT(count, 100000);
  const double of_network = static_cast<double>(network_right) / count;
  const double of_map = static_cast<double>(map_right) / count;
  std::cout << "network " << of_network << ", map " << of_map << " of " << count << " points\n";
  RecordProperty("network", std::to_string(of_network));
  RecordProperty("map", std::to_string(of_map));
  EXPECT_GT(of_network, 0.95);
  EXPECT_GE(of_map, of_network);
}

}  // namespace
}  // namespace csom
