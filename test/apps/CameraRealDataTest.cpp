// SPDX-License-Identifier: BSD-3-Clause
// Real images, a real network, no poses: from a drive of KITTI to a map, by csom and by MRPT.
#include <csom/io/TrajectoryFile.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/RunMrpt.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

constexpr std::size_t kScans = 5;

class CameraRealData : public testing::Test {
 protected:
  void SetUp() override {
    const char* data = std::getenv("CSOM_DATA");
    if (data == nullptr)
      throw std::runtime_error("set the environment variable CSOM_DATA to the folder of real data");
    const std::string folder_of_data = data;
    const auto imported =
        runCsom(folder.path(), {"import", "kitti-raw", folder_of_data + "/kitti_2011_09_26",
                                "--scans", "0:" + std::to_string(kScans), "-o", log_});
    ASSERT_EQ(imported.exit_code, 0) << imported.errors;

    std::string config = readBytes(CSOM_SOURCE_DIR "/config/kitti-raw.ini");
    replace(config, "network = networks/", "network = " CSOM_SOURCE_DIR "/config/networks/");
    replace(config, "; model =",
            "model = " + folder_of_data + "/models/espnetv2_s2.0_cityscapes_1280x320.onnx");
    writeBytes(config_, config);
  }

  static void replace(std::string& text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  }

  const TempFolder folder;
  const std::string log_ = folder / "jam.rawlog";
  const std::string config_ = folder / "kitti.ini";
};

TEST_F(CameraRealData, BecomesAMapWithPosesFromItsScansAndMrptMakesTheSame) {
  const auto run =
      runCsom(folder.path(), {"map", log_, "-c", config_, "--poses", "icp", "-o", folder / "out",
                              "--write-simplemap", folder / "jam.simplemap"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.errors, testing::HasSubstr("the simplemap refers to where they are now"));
  EXPECT_EQ(run.errorLines().size(), 1u) << run.errors;

  // A slow drive ahead, without a jump.
  const auto trajectory = readTumTrajectory(folder / "out/trajectory.tum");
  ASSERT_EQ(trajectory.size(), kScans);
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const Eigen::Vector3d step =
        trajectory[i].pose.translation() - trajectory[i - 1].pose.translation();
    EXPECT_LT(step.norm(), 0.5) << i;
    EXPECT_GT(step.x(), 0.1) << i;
    EXPECT_LT(std::abs(step.y()), 0.1) << i;
  }

  const auto record = nlohmann::json::parse(readBytes(folder / "out/run.json"));
  const auto& cameras = record.at("camera_labels");
  EXPECT_EQ(cameras.at("images").at("network_runs"), kScans);
  EXPECT_EQ(cameras.at("scans").at("labelled"), kScans);
  EXPECT_GT(cameras.at("points").at("labelled"), 10000 * kScans);
  for (const char* picture : {"camera-first-segmentation.jpg", "camera-middle-points.jpg",
                              "camera-last-points.jpg", "top.png"})
    EXPECT_GT(readBytes(folder / ("out/" + std::string(picture))).size(), 10000U) << picture;

  // The lane ahead is road at the height of the wheels, 1.73 m below the sensor.
  const MapDocument document = loadMap(folder / "out/map.csom");
  std::map<std::string, std::size_t> lane;
  for (double x = 7; x < 9; x += 0.2) {
    for (double y = -1; y < 1; y += 0.2) {
      for (double z = -2; z < -1.5; z += 0.1) {
        const DirichletVoxel voxel = document.map.at({x, y, z});
        if (voxel.state() == VoxelState::Occupied)
          ++lane[document.labels.at(voxel.mostLikelyClass()).name];
      }
    }
  }
  std::size_t occupied = 0;
  for (const auto& [name, count] : lane) occupied += count;
  EXPECT_GT(occupied, 50U);
  EXPECT_GT(lane["road"], occupied * 9 / 10);

  // MRPT's own program on the same observations and poses, the network included.
  const auto stock =
      runMrpt(folder.path(), {"observations2map", config_, folder / "jam.simplemap", "stock_"});
  ASSERT_EQ(stock.exit_code, 0) << stock.output << stock.errors;
  EXPECT_EQ(mapDigest(loadMap(folder / "stock__csom__CSemanticContinuousMap_00.csom").map),
            mapDigest(document.map));
}

TEST_F(CameraRealData, ASecondRunNeedsNoNetwork) {
  std::vector<std::string> digests;
  for (const std::size_t network_runs : {kScans, std::size_t{0}}) {
    const auto run = runCsom(folder.path(), {"map", log_, "-c", config_, "--poses", "icp", "-o",
                                             folder / "out", "--label-cache", folder / "cache"});
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    const auto record = nlohmann::json::parse(readBytes(folder / "out/run.json"));
    EXPECT_EQ(record.at("camera_labels").at("images").at("network_runs"), network_runs);
    digests.push_back(mapDigest(loadMap(folder / "out/map.csom").map));
  }
  EXPECT_EQ(digests[0], digests[1]);
}

}  // namespace
}  // namespace csom::test
