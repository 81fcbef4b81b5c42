// SPDX-License-Identifier: BSD-3-Clause
// Poses from real HDL-64E scans of streets.
#include <csom/rawlog/ImportKittiRaw.h>
#include <csom/rawlog/ImportSemanticKitti.h>
#include <csom/rawlog/MappingRun.h>

#include <cstdlib>

#include "rawlog/LogFixtures.h"

namespace csom::test {
namespace {

std::string dataFolder(const std::string& name) {
  const char* folder = std::getenv("CSOM_DATA");
  if (folder == nullptr)
    throw std::runtime_error("set the environment variable CSOM_DATA to the folder of real data");
  return std::string(folder) + "/" + name;
}

std::vector<TimedPose> registered(const TempFolder& folder, const std::string& log) {
  MappingRequest request;
  request.logs = {log};
  request.config_file = writeConfig(folder, "point_labels = none\nunlabelled_class = wall");
  request.poses = PoseChoice::parse("icp");
  const MappingResult result = mapLogs(request);
  EXPECT_EQ(result.registration->statistics.doubtful, 0U);
  return result.trajectory;
}

TEST(RegistrationRealData, SemanticKittiIsNearItsTruePoses) {
  const TempFolder folder;
  SemanticKittiImport import;
  import.folder = dataFolder("semantickitti_08");
  import.world = SemanticKittiWorld::Velodyne;
  importSemanticKitti(import, folder / "log.rawlog");
  const PoseTrack truth = surveyRawlog(folder / "log.rawlog").robot_poses.at("poses");
  const auto trajectory = registered(folder, folder / "log.rawlog");
  ASSERT_EQ(trajectory.size(), 5U);
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const auto true_step =
        *truth.at(trajectory[i].timestamp) - *truth.at(trajectory[i - 1].timestamp);
    const Eigen::Isometry3d step = trajectory[i - 1].pose.inverse() * trajectory[i].pose;
    EXPECT_NEAR(true_step.norm(), 0.76, 0.05) << "7.6 m/s";
    const Eigen::Vector3d moved(true_step.x(), true_step.y(), true_step.z());
    EXPECT_LT((step.translation() - moved).norm(), 0.05) << "frame " << i;
    EXPECT_LT(Eigen::AngleAxisd(step.linear()).angle(), 0.007) << "frame " << i;
  }
}

TEST(RegistrationRealData, ATrafficJamIsDrivenThroughSmoothly) {
  const TempFolder folder;
  KittiRawImport import;
  import.folder = dataFolder("kitti_2011_09_26");
  importKittiRaw(import, folder / "jam.rawlog");
  const auto trajectory = registered(folder, folder / "jam.rawlog");
  ASSERT_EQ(trajectory.size(), 20U);
  Eigen::Vector3d last_step = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const Eigen::Vector3d step =
        (trajectory[i - 1].pose.inverse() * trajectory[i].pose).translation();
    EXPECT_GT(step.x(), 0.15) << "frame " << i;
    EXPECT_LT(step.norm(), 0.30) << "frame " << i;
    if (i > 1) {
      EXPECT_LT((step - last_step).norm(), 0.06) << "frame " << i;
    }
    last_step = step;
  }
}

}  // namespace
}  // namespace csom::test
