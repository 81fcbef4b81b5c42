// SPDX-License-Identifier: BSD-3-Clause
// From real data sets to maps, by the commands that the tutorial shows.
#include <csom/io/KittiReader.h>
#include <csom/io/TrajectoryFile.h>

#include <cmath>
#include <functional>
#include <map>

#include "apps/RunCsom.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::HasSubstr;

std::string dataFolder(const std::string& name) {
  const char* folder = std::getenv("CSOM_DATA");
  if (folder == nullptr)
    throw std::runtime_error("set the environment variable CSOM_DATA to the folder of real data");
  return std::string(folder) + "/" + name;
}

std::string configFile(const std::string& name) {
  return std::string(CSOM_SOURCE_DIR) + "/config/" + name;
}

class RealData : public testing::Test {
 protected:
  void import(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "import");
    arguments.insert(arguments.end(), {"-o", folder / "data.rawlog"});
    const auto run = runCsom(folder.path(), arguments);
    ASSERT_EQ(run.exit_code, 0) << run.errors;
  }
  MapDocument mapWith(const std::string& config) const {
    const auto run =
        runCsom(folder.path(), {"map", folder / "data.rawlog", "-c", config, "-o", folder / "out"});
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_THAT(run.errors, testing::MatchesRegex("(mapping .*\n)*")) << "progress at most";
    return loadMap(folder / "out/map.csom");
  }

  const TempFolder folder;
};

struct OfClass {
  double share = 0;   ///< of the occupied voxels
  double height = 0;  ///< mean z [m]
};

std::map<std::string, OfClass> classesOf(const MapDocument& document) {
  std::map<std::string, OfClass> classes;
  double occupied = 0;
  document.map.forEachVoxel([&](const VoxelIndex& index, const DirichletVoxel& voxel) {
    if (voxel.state() != VoxelState::Occupied) return;
    OfClass& found = classes[document.labels.at(voxel.mostLikelyClass()).name];
    found.share += 1;
    found.height += document.map.grid().center(index).z();
    occupied += 1;
  });
  for (auto& [name, found] : classes) {
    found.height /= found.share;
    found.share /= occupied;
  }
  return classes;
}

TEST_F(RealData, SemanticKittiShowsTheStreetWhereItIs) {
  const std::string sequence = dataFolder("semantickitti_08");
  import({"semantickitti", sequence, "--labels", "predictions", "--world", "velodyne"});
  const MapDocument document = mapWith(configFile("semantickitti.ini"));
  ASSERT_EQ(document.scans.size(), 5u);
  EXPECT_GT(document.scans[0].report.points, 100000u);

  auto classes = classesOf(document);
  for (const char* name : {"road", "sidewalk", "terrain", "vegetation", "building"})
    EXPECT_GT(classes[name].share, 0.03) << name;
  // The Velodyne is 1.7 m above the road.
  EXPECT_NEAR(classes["road"].height, -1.7, 0.5);
  EXPECT_GT(classes["vegetation"].height, classes["road"].height + 1);
  EXPECT_GT(classes["building"].height, classes["road"].height + 1);
  EXPECT_EQ(document.labels.at(document.map.at({8.0, 0.0, -1.75}).mostLikelyClass()).name, "road");
}

// The map must agree with the ground truth at least as well as the labels that it was made of.
TEST_F(RealData, SemanticKittiMapBeatsItsInput) {
  const std::string sequence = dataFolder("semantickitti_08");
  import({"semantickitti", sequence, "--labels", "predictions"});
  const MapDocument document = mapWith(configFile("semantickitti.ini"));
  const auto poses = readKittiPoses(sequence + "/poses.txt");
  const auto calibration = readKittiOdometryCalibration(sequence + "/calib.txt");
  std::size_t points = 0, map_right = 0, input_right = 0, covered = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    const std::string name = "00000" + std::to_string(i);
    const auto scan = readKittiScan(sequence + "/velodyne/" + name + ".bin");
    const auto truth = readKittiLabels(sequence + "/labels/" + name + ".label", scan.points.size());
    const auto input =
        readKittiLabels(sequence + "/predictions/" + name + ".label", scan.points.size());
    const Eigen::Isometry3d world = poses[i].value() * calibration;
    for (std::size_t k = 0; k < scan.points.size(); ++k) {
      const auto right = document.labels.classOfRaw(truth[k]);
      if (right.kind != LabelSet::RawKind::Class) continue;
      ++points;
      const auto voxel = document.map.at(world * scan.points[k].cast<double>());
      covered += voxel.known() ? 1 : 0;
      map_right += voxel.surfaceClass() == right.id ? 1 : 0;
      input_right += document.labels.classOfRaw(input[k]) == right ? 1 : 0;
    }
  }
  ASSERT_GT(points, 400000u);
  EXPECT_GT(covered, points * 99 / 100);
  EXPECT_GT(map_right, input_right);
}

TEST_F(RealData, StanfordConferenceRoomHasItsFurniture) {
  import({"pcd", dataFolder("stanford_conference"), "--single-scan"});
  const MapDocument document = mapWith(configFile("stanford.ini"));
  ASSERT_EQ(document.scans.size(), 1u);
  EXPECT_EQ(document.scans[0].report.points, 531443u);
  auto classes = classesOf(document);
  for (const char* name : {"wall", "chair", "table", "bookcase", "door", "beam", "clutter"})
    EXPECT_GT(classes[name].share, 0.005) << name;
  EXPECT_EQ(classes.count("ceiling") + classes.count("floor"), 0u) << "not among the files";
  EXPECT_NEAR(classes["table"].height, 0.7, 0.25);
  EXPECT_GT(classes["beam"].height, classes["chair"].height + 1);
}

// A real file of the wild: every row has a column too many.
TEST_F(RealData, AnnotatedSimulationHasFloorWallsAndSolids) {
  const std::string scans = dataFolder("sim_unstructured_annotated");
  const auto refused = runCsom(folder.path(), {"import", "pcd", scans, "-o", folder / "data.rawlog",
                                               "--irregular-rows", "refuse"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.errorLines(), testing::ElementsAre(HasSubstr("line 12")));

  import({"pcd", scans});
  writeBytes(folder / "labels.yaml",
             "name: annotated\nclasses:\n"
             "  - {id: 0, name: free, color: [255, 255, 255]}\n"
             "  - {id: 1, name: ground, color: [120, 120, 120]}\n"
             "  - {id: 2, name: wall, color: [200, 60, 40]}\n"
             "  - {id: 3, name: solid, color: [40, 90, 200]}\n");
  std::string config = readBytes(configFile("room.ini"));
  const std::string named = "label_set = simulator";
  ASSERT_NE(config.find(named), std::string::npos);
  config.replace(config.find(named), named.size(), "label_set = labels.yaml");
  writeBytes(folder / "annotated.ini", config);
  const MapDocument document = mapWith(folder / "annotated.ini");
  ASSERT_EQ(document.scans.size(), 12u);
  auto classes = classesOf(document);
  for (const char* name : {"ground", "wall", "solid"}) EXPECT_GT(classes[name].share, 0.05) << name;
  EXPECT_LT(classes["ground"].height, 0.3);
  EXPECT_GT(classes["wall"].height, classes["ground"].height + 0.3);
  // The sensors stand in free space.
  for (const ScanRecord& scan : document.scans) {
    const Eigen::Vector3d sensor(scan.origin[0], scan.origin[1], scan.origin[2]);
    EXPECT_NE(document.map.at(sensor).state(), VoxelState::Unknown) << sensor.transpose();
  }
}

TEST_F(RealData, KittiRawKeepsImagesAndScans) {
  import({"kitti-raw", dataFolder("kitti_2011_09_26"), "--scans", "0:6", "--every", "3"});
  EXPECT_TRUE(std::filesystem::exists(folder / "data_Images/image_02_0000000003.png"));
  // KITTI raw has no poses: a trajectory is needed.
  const auto none = runCsom(folder.path(), {"map", folder / "data.rawlog", "-c",
                                            configFile("semantickitti.ini"), "-o", folder / "out"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.errors, HasSubstr("--poses"));
}

}  // namespace
}  // namespace csom::test
