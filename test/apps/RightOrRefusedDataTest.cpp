// SPDX-License-Identifier: BSD-3-Clause
// Data from the field makes the right map or is refused with the reason: nothing is wrong in
// silence. Each test is a kind of fault that once made a wrong map with exit code 0.
#include <csom/maps/CSemanticContinuousMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "apps/RunCsom.h"
#include "rawlog/LogFixtures.h"

namespace csom::test {
namespace {

namespace fs = std::filesystem;
using mrpt::poses::CPose3D;
using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr char kSection[] = "[MappingApplication_semanticContinuousMap_00_";

class RightOrRefused : public testing::Test {
 protected:
  ProgramResult csom(const std::vector<std::string>& arguments,
                     const std::vector<std::string>& environment = {}) const {
    return runProgram(folder.path(), CSOM_PROGRAM, arguments, environment);
  }
  /// The map that must come out.
  MapDocument mapOf(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "map");
    arguments.insert(arguments.end(), {"-o", folder / "out"});
    const ProgramResult run = csom(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    warnings = run.errors;
    return loadMap(folder / "out/map.csom");
  }
  /// What the command says, which must fail.
  std::string refusalOf(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "map");
    arguments.insert(arguments.end(), {"-o", folder / "out"});
    const ProgramResult run = csom(arguments);
    EXPECT_NE(run.exit_code, 0) << run.output;
    EXPECT_FALSE(fs::exists(folder / "out/map.csom"));
    return run.errors;
  }
  json totals() const { return json::parse(readBytes(folder / "out/run.json")).at("totals"); }
  /// A map of free and occupied voxels of 0.1 m, with free space.
  std::string occupancyConfig(const std::string& keys = "") const {
    writeBytes(folder / "occupancy.ini",
               "[MappingApplication]\nsemanticContinuousMap_count = 1\n" + std::string(kSection) +
                   "creationOpts]\nresolution = 0.1\n" + kSection +
                   "insertOpts]\nmethod = s-csm\nfree_space = raycast\n" + keys);
    return folder / "occupancy.ini";
  }

  const TempFolder folder;
  mutable std::string warnings;
};

// --- A1: a return is never evidence of free space ------------------------------------------------

constexpr double kWall = 5.05;

/// A wall of 5 x 5 points; `label`: a column more.
std::string wallPcd(const std::string& field, const std::string& label) {
  const std::string one = field.empty() ? "" : " 1";
  const std::string four = field.empty() ? "" : " 4";
  std::string text = "VERSION 0.7\nFIELDS x y z" + (field.empty() ? "" : " " + field) +
                     "\nSIZE 4 4 4" + four + "\nTYPE F F F" + (field.empty() ? "" : " U") +
                     "\nCOUNT 1 1 1" + one +
                     "\nWIDTH 25\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 25\nDATA ascii\n";
  for (int y = 0; y < 5; ++y)
    for (int z = 0; z < 5; ++z)
      text += "5.05 " + std::to_string(0.05 + 0.1 * y) + " " + std::to_string(0.05 + 0.1 * z) +
              (field.empty() ? "" : " " + label) + "\n";
  return text;
}

void expectOccupiedWall(const MapDocument& document) {
  for (int y = 0; y < 5; ++y)
    for (int z = 0; z < 5; ++z)
      EXPECT_EQ(document.map.at({kWall, 0.05 + 0.1 * y, 0.05 + 0.1 * z}).state(),
                VoxelState::Occupied)
          << y << ", " << z;
}

TEST_F(RightOrRefused, A1_PcdPointsWithoutAUsableLabelAreObstacles) {
  const std::string config = CSOM_SOURCE_DIR "/config/pcd.ini";
  for (const auto& [field, label] : {std::pair<std::string, std::string>{"label", "3"},
                                     {"label", "0"},
                                     {"label", "77"},
                                     {"", ""},
                                     {"classification", "3"},
                                     {"intensity", "3"}}) {
    SCOPED_TRACE(field + " " + label);
    writeBytes(folder / "wall.pcd", wallPcd(field, label));
    const auto import = csom({"import", "pcd", folder / "wall.pcd", "-o", folder / "wall.rawlog"});
    ASSERT_EQ(import.exit_code, 0) << import.errors;
    const MapDocument document = mapOf({folder / "wall.rawlog", "-c", config});
    expectOccupiedWall(document);
    const bool labelled = field == "label" && label == "3";
    const ClassId expected = labelled ? ClassId{3} : document.labels.unlabelledClass();
    EXPECT_NE(expected, kFreeClass);
    EXPECT_EQ(document.map.at({kWall, 0.25, 0.25}).mostLikelyClass(), expected);
    EXPECT_EQ(totals().at("kept_unlabelled"), labelled ? 0 : 25);
  }
}

TEST_F(RightOrRefused, A1_ImportSaysWhereLabelsComeFromAndWhichFieldsThereAre) {
  const auto labelsOf = [&](const std::string& field, const std::vector<std::string>& more = {}) {
    writeBytes(folder / "wall.pcd", wallPcd(field, "3"));
    std::vector<std::string> command{"import", "pcd", folder / "wall.pcd", "-o",
                                     folder / "wall.rawlog"};
    command.insert(command.end(), more.begin(), more.end());
    const auto run = csom(command);
    return run.exit_code == 0 ? run.output : run.errors;
  };
  EXPECT_THAT(labelsOf("label"), HasSubstr("labels: the field 'label'"));
  EXPECT_THAT(labelsOf("Label"), HasSubstr("labels: the field 'Label'"));
  EXPECT_THAT(labelsOf(""), HasSubstr("labels: none; the fields are x, y, z;"));
  for (const char* field : {"classification", "class", "SEMANTIC", "labels"})
    EXPECT_THAT(labelsOf(field),
                AllOf(HasSubstr("labels: none"), HasSubstr("--labels " + std::string(field))));
  EXPECT_THAT(labelsOf("Classification", {"--labels", "classification"}),
              HasSubstr("labels: the field 'Classification'"));
  EXPECT_THAT(labelsOf("class", {"--labels", "semantic"}),
              HasSubstr("no field 'semantic' with one value a point; there are x, y, z, class"));
}

TEST_F(RightOrRefused, A1_FilesWithAndWithoutLabelsAreNotMixed) {
  writeBytes(folder / "1.pcd", wallPcd("label", "3"));
  writeBytes(folder / "2.pcd", wallPcd("intensity", "3"));
  const auto run =
      csom({"import", "pcd", folder / "1.pcd", folder / "2.pcd", "-o", folder / "x.rawlog"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.errors, HasSubstr("2.pcd: has no labels, but " + (folder / "1.pcd") +
                                    " has the field 'label'"));
}

mrpt::obs::CObservationVelodyneScan::Ptr velodyneCloud(
    const std::vector<std::array<float, 3>>& points, std::uint8_t intensity) {
  auto scan = mrpt::obs::CObservationVelodyneScan::Create();
  for (const auto& [x, y, z] : points) {
    scan->point_cloud.x.push_back(x);
    scan->point_cloud.y.push_back(y);
    scan->point_cloud.z.push_back(z);
    scan->point_cloud.intensity.push_back(intensity);
  }
  return scan;
}

mrpt::obs::CObservationRotatingScan::Ptr ring(const std::vector<std::uint16_t>& ranges) {
  auto scan = mrpt::obs::CObservationRotatingScan::Create();
  const auto columns = static_cast<int>(ranges.size());
  scan->rowCount = 1;
  scan->columnCount = static_cast<std::uint16_t>(columns);
  scan->rangeResolution = 0.01;
  scan->startAzimuth = -0.2;
  scan->azimuthSpan = 0.4;
  scan->rangeImage.setZero(1, columns);
  scan->intensityImage.setZero(1, columns);
  for (int i = 0; i < columns; ++i) scan->rangeImage(0, i) = ranges[static_cast<std::size_t>(i)];
  return scan;
}

mrpt::obs::CObservation3DRangeScan::Ptr depthCamera(const std::vector<std::uint16_t>& depths) {
  auto scan = mrpt::obs::CObservation3DRangeScan::Create();
  const auto columns = static_cast<int>(depths.size());
  scan->hasRangeImage = true;
  scan->rangeImage_setSize(1, columns);
  scan->rangeUnits = 0.001f;
  scan->range_is_depth = true;
  for (int i = 0; i < columns; ++i) scan->rangeImage(0, i) = depths[static_cast<std::size_t>(i)];
  scan->cameraParams.ncols = static_cast<std::uint32_t>(columns);
  scan->cameraParams.nrows = 1;
  scan->cameraParams.setIntrinsicParamsFromValues(20.0, 20.0, 0.5 * (columns - 1), 0);
  return scan;
}

/// A log with a pose and one observation.
std::string logOf(const std::string& file, const mrpt::obs::CObservation::Ptr& observation) {
  observation->sensorLabel = "sensor";
  observation->timestamp = mrpt::Clock::fromDouble(100);
  return writeLog(file, {robotPose(100, CPose3D()), observation});
}

TEST_F(RightOrRefused, A1_LabelsThatMeanFreeAreRejectedByNameInEveryPath) {
  // A label set without a table of raw ids: id 0 is the class free.
  const std::string config = writeConfig(folder, "method = s-csm\nfree_space = raycast\n");
  auto cloud = wallCloud(100);
  for (std::size_t i = 0; i < cloud->pointcloud->size(); ++i)
    std::dynamic_pointer_cast<mrpt::maps::CPointsMapXYZI>(cloud->pointcloud)
        ->setPointIntensity(i, 0);
  auto camera = depthCamera({2000, 2000, 2000, 2000, 2000, 2000, 2000, 2000});
  const auto by_id = std::make_shared<mrpt::obs::TPixelLabelInfo<1>>();
  by_id->setSize(1, 8);
  for (int i = 0; i < 8; ++i) by_id->setLabel(0, i, 0);
  camera->pixelLabels = by_id;
  auto named_camera = depthCamera({2000, 2000, 2000, 2000, 2000, 2000, 2000, 2000});
  const auto by_name = std::make_shared<mrpt::obs::TPixelLabelInfo<1>>();
  by_name->setSize(1, 8);
  for (int i = 0; i < 8; ++i) by_name->setLabel(0, i, 3);
  by_name->setLabelName(3, "free");
  named_camera->pixelLabels = by_name;
  for (const mrpt::obs::CObservation::Ptr& observation :
       {mrpt::obs::CObservation::Ptr(cloud),
        mrpt::obs::CObservation::Ptr(velodyneCloud({{2, 0, 0}, {2, 0.2f, 0}}, 0)),
        mrpt::obs::CObservation::Ptr(ring({200, 200, 200})), mrpt::obs::CObservation::Ptr(camera),
        mrpt::obs::CObservation::Ptr(named_camera)}) {
    SCOPED_TRACE(observation->GetRuntimeClass()->className);
    const std::string log = logOf(folder / "a.rawlog", observation);
    EXPECT_THAT(refusalOf({log, "-c", config}),
                AllOf(HasSubstr("none of its points can be used"),
                      HasSubstr("whose label is not in the label set 'walls', or means free")));
    // With a class for what has no label they are obstacles.
    writeConfig(folder, "method = s-csm\nfree_space = raycast\nunlabelled_class = unlabelled\n");
    const MapDocument kept = mapOf({log, "-c", config});
    std::size_t occupied = 0;
    kept.map.forEachVoxel([&](const VoxelIndex&, const DirichletVoxel& voxel) {
      occupied += voxel.state() == VoxelState::Occupied ? 1 : 0;
    });
    EXPECT_GT(occupied, 0u);
    fs::remove_all(folder / "out");
    writeConfig(folder, "method = s-csm\nfree_space = raycast\n");
  }
}

// --- A2: no-returns are no hits ------------------------------------------------------------------

TEST_F(RightOrRefused, A2_BeamsThatHitNothingAreNoHitsWhateverTheKindOfObservation) {
  auto laser = mrpt::obs::CObservation2DRangeScan::Create();
  laser->aperture = 1.0f;
  laser->maxRange = 20.0f;
  laser->resizeScanAndAssign(6, 5.0f, true);
  laser->setScanRange(1, 0.0f);
  laser->setScanRange(2, -1.0f);
  laser->setScanRange(3, 20.0f);
  laser->setScanRange(4, 25.0f);
  laser->setScanRangeValidity(5, false);

  auto rotating = ring({500, 0, 65535, 500, 500, 2000});
  rotating->maxRange = 15;
  auto depth = depthCamera({3000, 0, 65535, 3000, 6000, 3000, 3000, 3000});
  depth->maxRange = 5.0f;
  auto points = mrpt::obs::CObservation3DRangeScan::Create();
  points->hasPoints3D = true;
  points->points3D_x = {1, 0, 0};
  points->points3D_y = {0, 0, 0};
  points->points3D_z = {0, 0, 0};
  points->points3D_idxs_x = {0, 1, 2};
  points->points3D_idxs_y = {0, 0, 0};
  auto velodyne = velodyneCloud({{5, 0, 0}, {0, 0, 0}, {400, 0, 0}}, 1);
  auto cloud = mrpt::maps::CSimplePointsMap::Create();
  cloud->insertPoint(0, 0, 0);
  cloud->insertPoint(3, 0, 0);
  auto cloud_observation = mrpt::obs::CObservationPointCloud::Create();
  cloud_observation->pointcloud = cloud;

  struct Case {
    mrpt::obs::CObservation::Ptr observation;
    std::size_t hits, no_returns;
  };
  for (const Case& c : {Case{laser, 1, 5}, Case{rotating, 3, 3}, Case{depth, 5, 3},
                        Case{points, 1, 2}, Case{velodyne, 1, 2}, Case{cloud_observation, 1, 1}}) {
    SCOPED_TRACE(c.observation->GetRuntimeClass()->className);
    const MapDocument document =
        mapOf({logOf(folder / "a.rawlog", c.observation), "-c", occupancyConfig()});
    EXPECT_EQ(totals().at("points"), c.hits);
    EXPECT_EQ(totals().at("no_returns"), c.no_returns);
    EXPECT_EQ(totals().at("rejected"), 0) << "a beam without a return is no point";
    EXPECT_NE(document.map.at({0, 0, 0}).state(), VoxelState::Occupied) << "the sensor's own voxel";
  }
}

TEST_F(RightOrRefused, A2_PcdPointsAtZeroAreNoHits) {
  for (const char* viewpoint : {"0 0 0", "2 3 0.5"}) {
    SCOPED_TRACE(viewpoint);
    writeBytes(folder / "zero.pcd",
               "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 3\nHEIGHT 1\n"
               "VIEWPOINT " +
                   std::string(viewpoint) +
                   " 1 0 0 0\nPOINTS 3\nDATA ascii\n0 0 0\n4.05 3.05 0.55\n0 0 0\n");
    const auto import = csom({"import", "pcd", folder / "zero.pcd", "-o", folder / "zero.rawlog"});
    ASSERT_EQ(import.exit_code, 0) << import.errors;
    EXPECT_THAT(import.errors, HasSubstr("2 points lie at exactly 0, 0, 0"));
    const MapDocument document = mapOf({folder / "zero.rawlog", "-c", occupancyConfig()});
    EXPECT_EQ(totals().at("no_returns"), 2);
    EXPECT_NE(document.map.at({0.05, 0.05, 0.05}).state(), VoxelState::Occupied);
    EXPECT_NE(document.map.at({2.05, 3.05, 0.55}).state(), VoxelState::Occupied);
    EXPECT_EQ(document.map.at({4.05, 3.05, 0.55}).state(), VoxelState::Occupied);
  }
}

// --- A3, A4, A7: data sets by the numbers of their frames ---------------------------------------

void append(std::string& bytes, float value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string kittiScan() {
  std::string bytes;
  for (int i = 0; i < 20; ++i)
    for (const float value : {2.0f, 0.1f * static_cast<float>(i - 10), 0.0f, 0.5f})
      append(bytes, value);
  return bytes;
}

std::string numbered(int number, int digits) {
  const std::string text = std::to_string(number);
  return std::string(static_cast<std::size_t>(digits) - text.size(), '0') + text;
}

/// x = 10 m times the line, but for the lines in `blank`.
std::string kittiPoses(int lines, const std::set<int>& blank = {}) {
  std::string text;
  for (int i = 0; i < lines; ++i)
    text += blank.count(i) > 0 ? "\n" : "1 0 0 " + std::to_string(10 * i) + " 0 1 0 0 0 0 1 0\n";
  return text;
}

class DataSets : public RightOrRefused {
 protected:
  DataSets() {
    fs::create_directories(drive + "/velodyne_points/data");
    fs::create_directories(sequence + "/velodyne");
  }
  void addScans(const std::vector<int>& frames) const {
    for (const int frame : frames) {
      writeBytes(drive + "/velodyne_points/data/" + numbered(frame, 10) + ".bin", kittiScan());
      writeBytes(sequence + "/velodyne/" + numbered(frame, 6) + ".bin", kittiScan());
    }
    writeBytes(sequence + "/calib.txt", "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n");
  }
  void addImages(const std::vector<int>& frames, const std::string& extension) const {
    fs::create_directories(drive + "/image_02/data");
    for (const int frame : frames)
      ASSERT_TRUE(cv::imwrite(drive + "/image_02/data/" + numbered(frame, 10) + extension,
                              cv::Mat(24, 64, CV_8UC3, cv::Scalar(10, 200, 30))));
    fs::create_directories(drive + "/calib");
    writeBytes(drive + "/calib/calib_velo_to_cam.txt", "R: 0 -1 0 0 0 -1 1 0 0\nT: 0 0 0\n");
    std::string cameras = "R_rect_00: 1 0 0 0 1 0 0 0 1\n";
    cameras += "P_rect_02: 30 0 32 0 0 30 12 0 0 0 1 0\nS_rect_02: 64 24\n";
    writeBytes(drive + "/calib/calib_cam_to_cam.txt", cameras);
  }
  ProgramResult importDrive(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> command{"import", "kitti-raw", drive, "-o", log};
    command.insert(command.end(), more.begin(), more.end());
    return csom(command);
  }
  /// Times of the observations of a sensor.
  std::vector<double> timesOf(const std::string& sensor) const {
    std::vector<double> times;
    RawlogReader reader(log);
    while (const auto entry = reader.next())
      for (const auto& observation : entry->observations)
        if (observation->sensorLabel == sensor)
          times.push_back(mrpt::Clock::toDouble(observation->timestamp));
    return times;
  }
  std::vector<double> originsOf(const MapDocument& document) const {
    std::vector<double> x;
    for (const ScanRecord& scan : document.scans) x.push_back(scan.origin[0]);
    return x;
  }

  const std::string drive = folder / "drive";
  const std::string sequence = folder / "sequence";
  const std::string log = folder / "x.rawlog";
};

using testing::DoubleNear;
const auto near = [](double value) { return DoubleNear(value, 1e-5); };

TEST_F(DataSets, A3_TimesAreThoseOfTheirLineAlsoBehindBlankOnes) {
  addScans({0, 1, 2, 5, 6});
  writeBytes(drive + "/velodyne_points/timestamps.txt", "0.0\n0.1\n0.2\n\n\n0.5\n0.6\n");
  ASSERT_EQ(importDrive().exit_code, 0);
  EXPECT_THAT(timesOf("velodyne"),
              ElementsAre(near(0), near(0.1), near(0.2), near(0.5), near(0.6)));
  ASSERT_EQ(importDrive({"--scans", "0:4"}).exit_code, 0);
  EXPECT_THAT(timesOf("velodyne"), ElementsAre(near(0), near(0.1), near(0.2), near(0.5)));
  writeBytes(drive + "/velodyne_points/timestamps.txt", "0.0\n0.1\n\n\n\n0.5\n0.6\n");
  const auto blank = importDrive();
  EXPECT_EQ(blank.exit_code, 1);
  EXPECT_THAT(blank.errors, AllOf(HasSubstr("timestamps.txt"), HasSubstr("line 3 is blank"),
                                  HasSubstr("0000000002.bin")));
  writeBytes(sequence + "/poses.txt", kittiPoses(7));
  writeBytes(sequence + "/times.txt", "0.0\n0.1\n0.2\n\n\n0.5\n0.6\n");
  ASSERT_EQ(csom({"import", "semantickitti", sequence, "-o", log}).exit_code, 0);
  EXPECT_THAT(timesOf("velodyne"),
              ElementsAre(near(0), near(0.1), near(0.2), near(0.5), near(0.6)));
}

TEST_F(DataSets, A3_PosesAreThoseOfTheirLineAlsoBehindBlankOnes) {
  addScans({0, 1, 2, 3});
  writeBytes(sequence + "/poses.txt", kittiPoses(4, {2}));
  const auto import = csom({"import", "semantickitti", sequence, "-o", log});
  ASSERT_EQ(import.exit_code, 0) << import.errors;
  EXPECT_THAT(import.errors, AllOf(HasSubstr("left out 1 scans whose line in poses.txt is blank"),
                                   HasSubstr("000002.bin")));
  EXPECT_THAT(originsOf(mapOf({log, "-c", occupancyConfig()})),
              ElementsAre(near(0), near(10), near(30)));
  writeBytes(sequence + "/poses.txt", "# poses\n" + kittiPoses(4));
  const auto comment = csom({"import", "semantickitti", sequence, "-o", log});
  EXPECT_EQ(comment.exit_code, 1);
  EXPECT_THAT(comment.errors, HasSubstr("line 1: a comment"));
}

TEST_F(DataSets, A3_ImagesHaveTimesOfTheirOwn) {
  addScans({0, 1});
  addImages({0, 1}, ".png");
  writeBytes(drive + "/velodyne_points/timestamps.txt", "0.0\n0.1\n");
  writeBytes(drive + "/image_02/timestamps.txt", "0.02\n0.12\n");
  ASSERT_EQ(importDrive().exit_code, 0);
  EXPECT_THAT(timesOf("image_02"), ElementsAre(near(0.02), near(0.12)));
  EXPECT_THAT(timesOf("velodyne"), ElementsAre(near(0), near(0.1)));
}

TEST_F(DataSets, A3_FilesWhoseNamesAreNoNumbersAreRefused) {
  addScans({0, 1});
  fs::rename(sequence + "/velodyne/000001.bin", sequence + "/velodyne/scan_1.bin");
  writeBytes(sequence + "/poses.txt", kittiPoses(4));
  const auto run = csom({"import", "semantickitti", sequence, "-o", log});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.errors, HasSubstr("scan_1.bin: its name is no number"));
  fs::rename(sequence + "/velodyne/scan_1.bin", sequence + "/velodyne/0.bin");
  EXPECT_THAT(csom({"import", "semantickitti", sequence, "-o", log}).errors,
              HasSubstr("is frame 0, and so is"));
}

TEST_F(DataSets, C_FilesThatCannotBeReadAreNotPassedOver) {
  addScans({0, 1});
  addImages({0, 1}, ".png");
  for (const std::string& broken :
       {drive + "/velodyne_points/data/0000000002.bin", drive + "/image_02/data/0000000002.png"}) {
    fs::create_symlink("/not/mounted", broken);
    const auto run = importDrive();
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.errors, HasSubstr(broken + ": is a link to a file that is not there"));
    fs::remove(broken);
  }
}

TEST_F(DataSets, A4_KittiPosesGoByTheNumbersOfFrames) {
  addScans({0, 1, 2, 5, 6, 7});
  writeBytes(folder / "p8.txt", kittiPoses(8));
  const std::string poses = "kitti:" + (folder / "p8.txt");
  const std::string config = occupancyConfig();
  ASSERT_EQ(importDrive().exit_code, 0);
  EXPECT_THAT(originsOf(mapOf({log, "-c", config, "--poses", poses})),
              ElementsAre(near(0), near(10), near(20), near(50), near(60), near(70)));
  ASSERT_EQ(importDrive({"--scans", "1:6", "--every", "2"}).exit_code, 0);
  EXPECT_THAT(originsOf(mapOf({log, "-c", config, "--poses", poses})),
              ElementsAre(near(10), near(50), near(70)));
  // As many poses as scans: those of these scans.
  writeBytes(folder / "p3.txt", kittiPoses(3));
  EXPECT_THAT(originsOf(mapOf({log, "-c", config, "--poses", "kitti:" + (folder / "p3.txt")})),
              ElementsAre(near(0), near(10), near(20)));
  fs::remove_all(folder / "out");
  writeBytes(folder / "p5.txt", kittiPoses(5));
  EXPECT_THAT(refusalOf({log, "-c", config, "--poses", "kitti:" + (folder / "p5.txt")}),
              AllOf(HasSubstr("p5.txt: has 5 poses"), HasSubstr("frame 7")));
}

TEST_F(DataSets, A4_CountsThatDoNotFitStopTheRun) {
  writeLog(log, driveEntries(4));
  const std::string config = occupancyConfig();
  for (const int lines : {3, 5}) {
    writeBytes(folder / "p.txt", kittiPoses(lines));
    EXPECT_THAT(
        refusalOf({log, "-c", config, "--poses", "kitti:" + (folder / "p.txt")}),
        AllOf(HasSubstr("has " + std::to_string(lines) + " poses"), HasSubstr("4 of 'lidar'")));
  }
  writeBytes(folder / "p.txt", kittiPoses(4));
  EXPECT_THAT(originsOf(mapOf({log, "-c", config, "--poses", "kitti:" + (folder / "p.txt")})),
              ElementsAre(near(0), near(10), near(20), near(30)));
}

TEST_F(DataSets, A4_LabelsThatAreNotThoseOfTheirScanStopTheImport) {
  addScans({0, 1});
  writeBytes(sequence + "/poses.txt", kittiPoses(2));
  fs::create_directories(sequence + "/labels");
  writeBytes(sequence + "/labels/000000.label", std::string(20 * 4, '\0'));
  std::vector<std::string> command{"import", "semantickitti", sequence, "--labels", "labels", "-o",
                                   log};
  EXPECT_THAT(csom(command).errors, HasSubstr("000001.label: no such file"));
  writeBytes(sequence + "/labels/000001.label", std::string(19 * 4, '\0'));
  EXPECT_THAT(csom(command).errors, HasSubstr("scan and labels do not belong together"));
}

TEST_F(DataSets, A4_ImagesAgainstScansAreCounted) {
  addScans({0, 1, 4, 5});
  addImages({0, 2, 3, 4, 5}, ".png");
  const auto import = importDrive();
  ASSERT_EQ(import.exit_code, 0) << import.errors;
  EXPECT_THAT(import.output, HasSubstr("4 scans, 80 points, 3 images"));
  EXPECT_THAT(
      import.errors,
      AllOf(HasSubstr("image_02: 1 scans have no image"), HasSubstr("frame 1"),
            HasSubstr("image_02: 2 images belong to frames without a scan"), HasSubstr("frame 2")));
}

TEST_F(DataSets, A7_JpegDrivesAreRead) {
  for (const char* extension : {".jpg", ".jpeg", ".JPG"}) {
    fs::remove_all(drive + "/image_02");
    addScans({0, 1});
    addImages({0, 1}, extension);
    for (const bool embedded : {false, true}) {
      SCOPED_TRACE(std::string(extension) + (embedded ? " embedded" : ""));
      fs::remove_all(folder / "x_Images");
      const auto import = embedded ? importDrive({"--embed-images"}) : importDrive();
      ASSERT_EQ(import.exit_code, 0) << import.errors;
      EXPECT_THAT(import.output, HasSubstr("2 images"));
      EXPECT_THAT(import.errorLines(), testing::IsEmpty());
      EXPECT_EQ(timesOf("image_02").size(), 2u);
    }
  }
}

// --- A5: gaps ------------------------------------------------------------------------------------

TEST_F(RightOrRefused, A5_PosesAreNotInterpolatedAcrossGaps) {
  Entries entries;
  for (int i = 0; i < 10; ++i) entries.push_back(wallCloud(1000 + 0.1 * i));
  const std::string log = writeLog(folder / "a.rawlog", entries);
  const std::string config = writeConfig(folder);
  writeBytes(folder / "gap.tum", "-2600 0 0 0 0 0 0 1\n4600 10 0 0 0 0 0 1\n");
  EXPECT_THAT(refusalOf({log, "-c", config, "--poses", "tum:" + (folder / "gap.tum")}),
              AllOf(HasSubstr("too far apart in time"), HasSubstr("-2600.000 to 4600.000")));

  // In the middle of a trajectory: what lies in the gap is refused, the rest is mapped.
  std::string tum;
  for (int i = 0; i <= 9; ++i)
    if (i < 3 || i > 6)
      tum += std::to_string(1000 + 0.1 * i) + " " + std::to_string(i) + " 0 0 0 0 0 1\n";
  for (int i = 0; i < 10; ++i)
    tum += std::to_string(1030 + 0.1 * i) + " " + std::to_string(i) + " 0 0 0 0 0 1\n";
  writeBytes(folder / "some.tum", tum);
  entries.push_back(wallCloud(1015));
  writeLog(log, entries);
  const MapDocument document =
      mapOf({log, "-c", config, "--poses", "tum:" + (folder / "some.tum")});
  EXPECT_EQ(document.scans.size(), 10u) << "0.4 s are no gap, 29 s are";
  EXPECT_THAT(warnings,
              AllOf(HasSubstr("1 observations have no pose"), HasSubstr("1000.900 to 1030.000")));
}

TEST_F(RightOrRefused, A5_PosesOfTheLogHaveGapsToo) {
  Entries entries;
  for (int i = 0; i < 10; ++i) {
    entries.push_back(robotPose(100 + 0.1 * i, {0.1 * i, 0.0, 0.0, 0.0, 0.0, 0.0}));
    entries.push_back(wallCloud(100 + 0.1 * i));
  }
  entries.push_back(wallCloud(2000));
  entries.push_back(robotPose(3700, {50.0, 0.0, 0.0, 0.0, 0.0, 0.0}));
  const MapDocument document =
      mapOf({writeLog(folder / "a.rawlog", entries), "-c", writeConfig(folder)});
  EXPECT_EQ(document.scans.size(), 10u);
  EXPECT_THAT(warnings, HasSubstr("100.900 to 3700.000"));
}

TEST_F(RightOrRefused, A5_ARobotThatStandsMayBeSilent) {
  Entries entries{robotPose(100, CPose3D()), wallCloud(2000), robotPose(3700, CPose3D())};
  EXPECT_EQ(mapOf({writeLog(folder / "a.rawlog", entries), "-c", writeConfig(folder)}).scans.size(),
            1u);
}

TEST_F(RightOrRefused, A5_AGapFarBeyondTheScansOwnSpacingIsWarnedOf) {
  Entries entries;
  for (int i = 0; i < 100; ++i) entries.push_back(wallCloud(1000 + 0.1 * i));
  writeBytes(folder / "sparse.tum", "1000 0 0 0 0 0 0 1\n1005 1 0 0 0 0 0 1\n1010 2 0 0 0 0 0 1\n");
  mapOf({writeLog(folder / "a.rawlog", entries), "-c", writeConfig(folder), "--poses",
         "tum:" + (folder / "sparse.tum")});
  EXPECT_THAT(warnings, AllOf(HasSubstr("interpolated across gaps of up to 5.000 s"),
                              HasSubstr("observations are 0.100 s apart")));
}

// --- A6: the ini language is MRPT's
// ---------------------------------------------------------------

class IniLanguage : public RightOrRefused {
 protected:
  std::string ini(const std::string& head, const std::string& resolution,
                  const std::string& insertion = "method = s-csm\n") const {
    writeBytes(folder / "language.ini",
               head + "[MappingApplication]\nsemanticContinuousMap_count = 1\n" + kSection +
                   "creationOpts]\nlabel_set = numbered\nresolution = " + resolution + "\n" +
                   kSection + "insertOpts]\npoint_labels = intensity\n" + insertion);
    return folder / "language.ini";
  }
  const std::string log = writeLog(folder / "a.rawlog", driveEntries(2));
};

TEST_F(IniLanguage, A6_FormulasDefinitionsAndVariablesAreReadAsMrptReadsThem) {
  for (const auto& [head, resolution] : {std::pair<std::string, std::string>{"", "$eval{0.05*4}"},
                                         {"@define R 0.1\n", "$eval{R*2}"},
                                         {"@define R 0.2\n", "${R}"},
                                         {"", "$env{CSOM_TEST_RESOLUTION}"},
                                         {"", "0.\\\n2"}}) {
    SCOPED_TRACE(resolution);
    const std::string config = ini(head, resolution, "method = s-csm\nblock_depth = $eval{1+2}\n");
    const std::vector<std::string> variable{"CSOM_TEST_RESOLUTION=0.2"};
    const auto run = csom({"map", log, "-c", config, "-o", folder / "out"}, variable);
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    const Options options = loadMap(folder / "out/map.csom").map.options();
    EXPECT_DOUBLE_EQ(options.resolution, 0.2);
    EXPECT_EQ(options.block_depth, 3);
    const auto with = csom({"with", "--", "observations2map", config}, variable);
    EXPECT_THAT(with.errors, testing::Not(HasSubstr("language.ini"))) << "that it does not refuse";
  }
}

TEST_F(IniLanguage, A6_KeysAndSectionsGivenTwiceAreErrorsThatNameBothLines) {
  EXPECT_THAT(refusalOf({log, "-c", ini("", "0.2\nResolution = 0.1")}),
              AllOf(HasSubstr("Resolution is given twice"), HasSubstr("line 5 and in line 6")));
  EXPECT_THAT(refusalOf({log, "-c", ini("", "0.\\\n2\nlabel_set = stanford")}),
              AllOf(HasSubstr("label_set is given twice"), HasSubstr("line 4 and in line 7")));
  EXPECT_THAT(refusalOf({log, "-c",
                         ini("", "0.2",
                             "method = s-csm\n" + std::string(kSection) +
                                 "creationOpts]\nenableSaveAs3DObject = true\n")}),
              AllOf(HasSubstr("creationOpts] is given twice"), HasSubstr("line 3 and in line 9")));
  EXPECT_THAT(
      refusalOf({log, "-c", ini("[MappingApplication]\n", "0.2")}),
      AllOf(HasSubstr("[MappingApplication] is given twice"), HasSubstr("line 1 and in line 2")));
  const auto with = csom({"with", "--", "observations2map", ini("", "0.2\nresolution = 0.1")});
  EXPECT_EQ(with.exit_code, 2);
  EXPECT_THAT(with.errors, HasSubstr("line 5 and in line 6"));
  // What is none of ours is none of our business.
  EXPECT_EQ(mapOf({log, "-c", ini("[Other]\na = 1\na = 2\n", "0.2")}).scans.size(), 2u);
}

// --- A8: refusals say why and what to do
// ------------------------------------------------------------

TEST_F(RightOrRefused, A8_ACameraThatLooksPastThePointsIsNamedWithItsDirection) {
  auto labels = mrpt::obs::CObservationImage::Create();
  labels->image = mrpt::img::CImage(64, 48, mrpt::img::CH_GRAY);
  labels->image.filledRectangle(0, 0, 63, 47, mrpt::img::TColor(1, 1, 1));
  labels->sensorLabel = "ids";
  labels->timestamp = mrpt::Clock::fromDouble(100);
  labels->cameraParams.ncols = 64;
  labels->cameraParams.nrows = 48;
  labels->cameraParams.setIntrinsicParamsFromValues(60, 60, 32, 24);
  const std::string log =
      writeLog(folder / "a.rawlog", {robotPose(100, CPose3D()), labels, wallCloud(100)});
  writeConfig(folder, "method = s-csm\n" + std::string(kSection) +
                          "labelSource_00]\nsensor_label = camera\nsource = label_image\n"
                          "label_image = ids\n" +
                          kSection + "labelOpts]\nvisibility = off\nedge_margin = 0\n");
  std::string config = readBytes(folder / "map.ini");
  const std::string own = "point_labels = intensity";
  config.replace(config.find(own), own.size(), "point_labels = none");
  writeBytes(folder / "map.ini", config);
  mapOf({log, "-c", folder / "map.ini"});
  EXPECT_THAT(warnings, AllOf(HasSubstr("points lie outside of the view of all cameras"),
                              HasSubstr("'camera' looks along (0.00, 0.00, 1.00)"),
                              HasSubstr("yaw -90, roll -90")));
}

TEST_F(RightOrRefused, A8_TimesInAnotherUnitAreNamedWithBothSpans) {
  const std::string log = writeLog(folder / "a.rawlog", {wallCloud(1e9), wallCloud(1e9 + 1)});
  const std::string config = writeConfig(folder);
  for (const auto& [factor, unit] : {std::pair<double, const char*>{1e3, "milliseconds"},
                                     {1e6, "microseconds"},
                                     {1e9, "nanoseconds"}}) {
    std::string tum;
    for (int i = 0; i < 3; ++i) tum += std::to_string(factor * (1e9 + i)) + " 0 0 0 0 0 0 1\n";
    writeBytes(folder / "times.tum", tum);
    EXPECT_THAT(refusalOf({log, "-c", config, "--poses", "tum:" + (folder / "times.tum")}),
                AllOf(HasSubstr("outside of the time of the poses"),
                      HasSubstr("the observations from 1000000000.000 to 1000000001.000 s"),
                      HasSubstr(std::string("seem to be in ") + unit)));
  }
}

TEST_F(RightOrRefused, A8_CoordinatesOfACountrysGridAreNamedWithTheLimit) {
  const std::string log =
      writeLog(folder / "a.rawlog",
               {robotPose(100, {455000.25, 4438000.75, 100.0, 0.0, 0.0, 0.0}), wallCloud(100)});
  EXPECT_THAT(refusalOf({log, "-c", occupancyConfig()}),
              AllOf(HasSubstr("with voxels of 0.1 m a map reaches 839 km"),
                    HasSubstr("the robot was at (455000.2, 4438000.8, 100.0)"),
                    HasSubstr("Subtract one offset from all poses")));
  writeBytes(folder / "utm.pcd",
             "VERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\n"
             "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n455000.25 4438000.75 100\n"
             "455001.25 4438000.75 100\n");
  const auto import = csom({"import", "pcd", folder / "utm.pcd", "-o", folder / "utm.rawlog"});
  EXPECT_EQ(import.exit_code, 1);
  EXPECT_THAT(import.errors, AllOf(HasSubstr("2 of its 2 points lie more than 131 km"),
                                   HasSubstr("subtract one offset")));
}

// --- A9: points that no camera sees are obstacles too
// -----------------------------------------------

TEST_F(RightOrRefused, A9_TheShippedCameraConfigurationsKeepWhatNoCameraSees) {
  for (const char* name : {"campus-camera.ini", "kitti-raw.ini"})
    EXPECT_EQ(
        CSemanticContinuousMap::definitionFromIni(std::string(CSOM_SOURCE_DIR "/config/") + name)
            .labelOpts.outside_view,
        OutsideView::Unlabelled)
        << name;
  const MapDocument document = mapOf({CSOM_SOURCE_DIR "/rawlogs/campus.rawlog", "-c",
                                      CSOM_SOURCE_DIR "/config/campus-camera.ini"});
  const json points = json::parse(readBytes(folder / "out/run.json"))["camera_labels"]["points"];
  const std::size_t outside = points.at("outside_view");
  EXPECT_GT(outside, points.at("labelled").get<std::size_t>()) << "most of a scan";
  EXPECT_GE(points.at("kept_unlabelled"), outside);
  // Behind the robot, where the camera never looks at the end of the drive.
  std::size_t unlabelled = 0;
  document.map.forEachVoxel([&](const VoxelIndex&, const DirichletVoxel& voxel) {
    unlabelled += voxel.state() == VoxelState::Occupied &&
                          voxel.mostLikelyClass() == document.labels.unlabelledClass()
                      ? 1
                      : 0;
  });
  EXPECT_GT(unlabelled, 1000u);
}

TEST_F(RightOrRefused, A9_WhatIsOutsideOfTheViewIsNotCalledRejected) {
  std::string config = readBytes(CSOM_SOURCE_DIR "/config/campus-camera.ini");
  const auto replace = [&](const std::string& from, const std::string& to) {
    config.replace(config.find(from), from.size(), to);
  };
  config += "\n[MappingApplication_semanticContinuousMap_00_labelOpts]\noutside_view = drop\n";
  replace("networks/campus.yaml", CSOM_SOURCE_DIR "/config/networks/campus.yaml");
  writeBytes(folder / "drop.ini", config);
  mapOf({CSOM_SOURCE_DIR "/rawlogs/campus.rawlog", "-c", folder / "drop.ini"});
  const json points = json::parse(readBytes(folder / "out/run.json"))["camera_labels"]["points"];
  EXPECT_EQ(totals().at("outside_view"), points.at("outside_view"));
  EXPECT_LT(totals().at("rejected"), points.at("outside_view"));
}

}  // namespace
}  // namespace csom::test
