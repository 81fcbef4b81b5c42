// SPDX-License-Identifier: BSD-3-Clause
// csom map with labels from a camera: what it leaves, says and counts.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/RunCsom.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string kLog = CSOM_SOURCE_DIR "/rawlogs/campus.rawlog";
const std::string kConfig = CSOM_SOURCE_DIR "/config/campus-camera.ini";

class CameraMap : public testing::Test {
 protected:
  ProgramResult map(const std::string& config, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"map", kLog, "-c", config, "-o", folder / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runCsom(folder.path(), arguments);
  }
  json record() const { return json::parse(readBytes(folder / "out/run.json")); }
  bool exists(const std::string& name) const {
    return std::filesystem::exists(folder / ("out/" + name));
  }
  /// The shipped configuration with another camera, and lines more for the first one.
  std::string configWith(const std::string& text) const {
    std::string config = readBytes(kConfig);
    const std::string network = "networks/campus.yaml";
    config.replace(config.find(network), network.size(),
                   CSOM_SOURCE_DIR "/config/networks/campus.yaml");
    writeBytes(folder / "map.ini", config + text);
    return folder / "map.ini";
  }

  const TempFolder folder;
};

TEST_F(CameraMap, LeavesCountsPicturesAndNoneOfAnEarlierRun) {
  const auto run = map(kConfig);
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.errors, testing::MatchesRegex("(mapping .*\n)*")) << "progress at most";
  EXPECT_THAT(run.output, HasSubstr("points labelled"));
  EXPECT_THAT(run.output,
              HasSubstr("68 CObservationImage: no label source of the ini names their sensor"));

  const json cameras = record().at("camera_labels");
  EXPECT_EQ(cameras.at("images").at("network_runs"), 68);
  EXPECT_EQ(cameras.at("scans").at("labelled"), 68);
  EXPECT_GT(cameras.at("added_share"), 0.0);
  std::size_t points = 0;
  for (const auto& [fate, count] : cameras.at("points").items())
    points += fate == "kept_unlabelled" ? 0 : count.get<std::size_t>();
  EXPECT_EQ(points, record().at("totals").at("points"));
  EXPECT_THAT(readBytes(folder / "out/report.html"), HasSubstr("What the camera saw"));
  EXPECT_TRUE(exists("camera-middle-points.jpg"));

  // Points that carry their labels: no camera, no pictures.
  ASSERT_EQ(map(CSOM_SOURCE_DIR "/config/campus.ini").exit_code, 0);
  EXPECT_FALSE(exists("camera-middle-points.jpg"));
  EXPECT_FALSE(record().contains("camera_labels"));
}

TEST_F(CameraMap, SaysWhichCameraNeverDelivers) {
  const std::string prefix = "[MappingApplication_semanticContinuousMap_00_labelSource_01]\n";
  const auto run = map(configWith(prefix + "sensor_label = rear\nsource = label_image\n" +
                                  "label_image = rear_ids\n"));
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.errors,
              testing::EndsWith("csom: warning: label source 'rear': no image of it was read\n"));
  EXPECT_EQ(record().at("camera_labels").at("scans").at("labelled"), 68)
      << "scans do not wait for it for ever";
}

TEST_F(CameraMap, SaysHowManyScansHadNoImage) {
  std::string config = readBytes(kConfig);
  const std::string camera = "sensor_label = camera\n";
  config.replace(config.find(camera), camera.size(), "sensor_label = nowhere\n");
  const std::string network = "networks/campus.yaml";
  config.replace(config.find(network), network.size(),
                 CSOM_SOURCE_DIR "/config/networks/campus.yaml");
  writeBytes(folder / "nowhere.ini", config);
  const auto run = map(folder / "nowhere.ini");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.errors, HasSubstr("68 scans had no image within max_time_offset"));
  const MapDocument document = loadMap(folder / "out/map.csom");
  const ClassId unlabelled = document.labels.unlabelledClass();
  ASSERT_NE(unlabelled, kFreeClass);
  document.map.forEachVoxel([&](const VoxelIndex&, const DirichletVoxel& voxel) {
    if (voxel.state() != VoxelState::Occupied) return;
    ASSERT_EQ(voxel.mostLikelyClass(), unlabelled);
  });
}

TEST_F(CameraMap, ACacheThatCannotBeWrittenToCostsNoLabel) {
  namespace fs = std::filesystem;
  const std::vector<std::string> with_cache{"--label-cache", folder / "cache"};
  ASSERT_EQ(map(kConfig, with_cache).exit_code, 0);
  const std::string digest = mapDigest(loadMap(folder / "out/map.csom").map);
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder / "cache")) files.push_back(entry.path());
  ASSERT_EQ(files.size(), 68U);
  for (const fs::path& file : files) {
    fs::remove(file);
    fs::create_directory(file);
  }
  const auto run = map(kConfig, with_cache);
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.errors, HasSubstr("what networks said is not kept for later runs"));
  EXPECT_THAT(run.errors, HasSubstr("cannot be written: Is a directory"));
  EXPECT_EQ(mapDigest(loadMap(folder / "out/map.csom").map), digest);
}

TEST_F(CameraMap, ADamagedModelStopsBeforeTheFirstImage) {
  std::string model = readBytes(CSOM_SOURCE_DIR "/config/networks/campus.onnx");
  writeBytes(folder / "damaged.onnx", model.substr(0, model.size() / 2));
  std::string config = readBytes(configWith(""));
  const std::string source = "source = network\n";
  config.insert(config.find(source), "model = " + (folder / "damaged.onnx") + "\n");
  writeBytes(folder / "damaged.ini", config);
  const auto run = map(folder / "damaged.ini");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.errors, HasSubstr("damaged.onnx: "));
  EXPECT_FALSE(exists("map.csom"));
}

}  // namespace
}  // namespace csom::test
