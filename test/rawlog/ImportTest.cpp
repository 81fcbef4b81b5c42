// SPDX-License-Identifier: BSD-3-Clause
// Data sets that the test writes itself, as rawlogs.
#include <csom/rawlog/ImportKittiRaw.h>
#include <csom/rawlog/ImportPcd.h>
#include <csom/rawlog/ImportSemanticKitti.h>
#include <csom/rawlog/RawlogSurvey.h>
#include <mrpt/obs/CObservationImage.h>

#include <opencv2/imgcodecs.hpp>

#include "rawlog/LogFixtures.h"

namespace csom::test {
namespace {

namespace fs = std::filesystem;
using mrpt::poses::CPose3D;
using testing::HasSubstr;

std::vector<mrpt::obs::CObservation::Ptr> observationsOf(const std::string& file) {
  RawlogReader reader(file);
  std::vector<mrpt::obs::CObservation::Ptr> all;
  while (const auto entry = reader.next())
    all.insert(all.end(), entry->observations.begin(), entry->observations.end());
  EXPECT_TRUE(reader.end().complete);
  return all;
}

template <class Kind>
std::vector<std::shared_ptr<Kind>> only(const std::vector<mrpt::obs::CObservation::Ptr>& all) {
  std::vector<std::shared_ptr<Kind>> some;
  for (const auto& observation : all) {
    if (auto kind = std::dynamic_pointer_cast<Kind>(observation)) some.push_back(kind);
  }
  return some;
}

std::vector<float> intensitiesOf(const mrpt::obs::CObservationPointCloud& cloud) {
  const auto& points = dynamic_cast<const mrpt::maps::CPointsMapXYZI&>(*cloud.pointcloud);
  std::vector<float> values;
  for (std::size_t i = 0; i < points.size(); ++i) values.push_back(points.getPointIntensity(i));
  return values;
}

std::string scanBytes(const std::vector<std::array<float, 4>>& points) {
  std::string bytes;
  for (const auto& point : points) {
    for (const float value : point) bytes += bytesOf(value);
  }
  return bytes;
}

/// Two scans of two points; Tr turns the Velodyne's axes into a camera's; pose 1 is 5 m ahead.
void writeSequence(const TempFolder& folder) {
  fs::create_directories(folder / "velodyne");
  fs::create_directories(folder / "labels");
  writeBytes(folder / "velodyne/000000.bin", scanBytes({{1, 2, 3, 0.5f}, {4, 5, 6, 0.25f}}));
  writeBytes(folder / "velodyne/000001.bin", scanBytes({{7, 8, 9, 0.125f}, {1, 1, 1, 1}}));
  writeBytes(folder / "labels/000000.label",
             bytesOf(std::uint32_t{40}) + bytesOf(std::uint32_t{0x00070000u + 259}));
  writeBytes(folder / "labels/000001.label",
             bytesOf(std::uint32_t{0}) + bytesOf(std::uint32_t{65535}));
  writeBytes(folder / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 5\n");
  const std::string p = ": 700 0 600 0 0 700 180 0 0 0 1 0\n";
  writeBytes(folder / "calib.txt",
             "P0" + p + "P1" + p + "P2" + p + "P3" + p + "Tr: 0 -1 0 0.1 0 0 -1 0.2 1 0 0 0.3\n");
}

TEST(NaturalLess, ComparesRunsOfDigitsAsNumbers) {
  std::vector<std::string> names{"a10", "a2", "a1", "b1", "a01", "a", "a10b", "a2/9", "a2/10"};
  std::sort(names.begin(), names.end(), naturalLess);
  EXPECT_THAT(names,
              testing::ElementsAre("a", "a01", "a1", "a2", "a2/9", "a2/10", "a10", "a10b", "b1"));
  EXPECT_FALSE(naturalLess("a01", "a01"));
}

TEST(ScanSelection, TakesRangesAndSteps) {
  using testing::ElementsAre;
  EXPECT_THAT(ScanSelection::parse("", 1).positions(3), ElementsAre(0, 1, 2));
  EXPECT_THAT(ScanSelection::parse("1:3", 1).positions(9), ElementsAre(1, 2));
  EXPECT_THAT(ScanSelection::parse("4:", 2).positions(9), ElementsAre(4, 6, 8));
  EXPECT_THAT(ScanSelection::parse(":100", 3).positions(5), ElementsAre(0, 3));
  EXPECT_THAT(ScanSelection::parse("7:", 1).positions(5), ElementsAre());
  for (const char* bad : {"3", "a:b", "1:2:3", "-1:2", "1: 2", "99999999999999999999:"})
    EXPECT_THROW(ScanSelection::parse(bad, 1), ConfigError) << bad;
  EXPECT_THROW(ScanSelection::parse("", 0), ConfigError);
}

TEST(ImportSemanticKitti, KeepsPointsLabelsAndPoses) {
  const TempFolder folder;
  writeSequence(folder);
  SemanticKittiImport request;
  request.folder = folder.path();
  request.labels = "labels";
  request.world = SemanticKittiWorld::Velodyne;
  const auto summary = importSemanticKitti(request, folder / "k.rawlog");
  EXPECT_EQ(summary.scans, 2u);
  EXPECT_EQ(summary.points, 4u);

  const auto all = observationsOf(folder / "k.rawlog");
  const auto clouds = only<mrpt::obs::CObservationPointCloud>(all);
  ASSERT_EQ(clouds.size(), 2u);
  float x = 0, y = 0, z = 0;
  clouds[0]->pointcloud->getPoint(1, x, y, z);
  EXPECT_EQ(x, 4);
  EXPECT_EQ(y, 5);
  EXPECT_EQ(z, 6);
  // The instance number in the high bits is left out.
  EXPECT_THAT(intensitiesOf(*clouds[0]), testing::ElementsAre(40, 259));
  EXPECT_THAT(intensitiesOf(*clouds[1]), testing::ElementsAre(0, 65535));
  EXPECT_NEAR(mrpt::Clock::toDouble(clouds[1]->timestamp), 0.1, 1e-6);

  const auto poses = only<mrpt::obs::CObservationRobotPose>(all);
  ASSERT_EQ(poses.size(), 2u);
  // 5 m along the camera's z are 5 m along the Velodyne's x.
  EXPECT_NEAR((poses[1]->pose.mean - CPose3D(5, 0, 0, 0, 0, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR(poses[1]->pose.mean.yaw(), 0, 1e-9);
}

TEST(ImportSemanticKitti, StaysInTheWorldOfTheCamera) {
  const TempFolder folder;
  writeSequence(folder);
  SemanticKittiImport request;
  request.folder = folder.path();
  importSemanticKitti(request, folder / "k.rawlog");
  const auto all = observationsOf(folder / "k.rawlog");
  const auto pose = only<mrpt::obs::CObservationRobotPose>(all).at(1)->pose.mean;
  const auto point = pose.composePoint({1, 2, 3});
  // pose · Tr · (1 2 3) = (−2, −3, 1) + (0.1, 0.2, 0.3) + (0, 0, 5)
  EXPECT_NEAR(point.x, -1.9, 1e-9);
  EXPECT_NEAR(point.y, -2.8, 1e-9);
  EXPECT_NEAR(point.z, 6.3, 1e-9);
  EXPECT_THAT(intensitiesOf(*only<mrpt::obs::CObservationPointCloud>(all).at(0)),
              testing::ElementsAre(0.5f, 0.25f));
}

TEST(ImportSemanticKitti, TakesTimesAndPosesOfTheNumberOfAFile) {
  const TempFolder folder;
  writeSequence(folder);
  writeBytes(folder / "times.txt", "0.0\n12.5\n");
  SemanticKittiImport request;
  request.folder = folder.path();
  request.world = SemanticKittiWorld::Velodyne;
  request.selection = ScanSelection::parse("1:2", 1);
  importSemanticKitti(request, folder / "k.rawlog");
  const auto pose = only<mrpt::obs::CObservationRobotPose>(observationsOf(folder / "k.rawlog"));
  ASSERT_EQ(pose.size(), 1u);
  EXPECT_NEAR(pose[0]->pose.mean.x(), 5, 1e-9);
  EXPECT_NEAR(mrpt::Clock::toDouble(pose[0]->timestamp), 12.5, 1e-6);
}

std::vector<double> importedTimes(const TempFolder& folder) {
  SemanticKittiImport request;
  request.folder = folder.path();
  importSemanticKitti(request, folder / "k.rawlog");
  std::vector<double> times;
  for (const auto& cloud :
       only<mrpt::obs::CObservationPointCloud>(observationsOf(folder / "k.rawlog")))
    times.push_back(mrpt::Clock::toDouble(cloud->timestamp));
  return times;
}

TEST(ImportSemanticKitti, ReadsTimesAsTheDataSetWritesThem) {
  const TempFolder folder;
  writeSequence(folder);
  using testing::DoubleNear;
  for (const char* end : {"\n", "\r\n", "\n\n", "\n \r\n\n", ""}) {
    writeBytes(folder / "times.txt", std::string("5.000000e-01\n1.037380e+02") + end);
    EXPECT_THAT(importedTimes(folder),
                testing::ElementsAre(DoubleNear(0.5, 1e-6), DoubleNear(103.738, 1e-6)));
  }
}

TEST(ImportSemanticKitti, RefusesTimesThatAreNone) {
  const TempFolder folder;
  writeSequence(folder);
  for (const char* bad :
       {"1.5abc", "nan", "inf", "1,5", "1 2", "noon", "2011-09-26", "2011-02-31 10:00:00",
        "2011-13-01 10:00:00", "2011-09-26 24:00:00", "2011-09-26 10:00", "-1-09-26 10:00:00",
        "2011-09-26 10:00:00.5x", "2011-09-26 10:00:00 1"}) {
    writeBytes(folder / "times.txt", "0.5\n" + std::string(bad) + "\n");
    EXPECT_THAT(fileErrorOf([&] { importedTimes(folder); }),
                HasSubstr("times.txt: line 2: '" + std::string(bad) + "' is no time"));
  }
  writeBytes(folder / "times.txt", "0.5\n\x1b[2J\n");
  EXPECT_THAT(fileErrorOf([&] { importedTimes(folder); }), HasSubstr("line 2: '?[2J'"));
}

TEST(ImportSemanticKitti, DoesNotMixTimesOfTheFileWithItsOwn) {
  const TempFolder folder;
  writeSequence(folder);
  writeBytes(folder / "times.txt", "1000.0\n");
  EXPECT_THAT(fileErrorOf([&] { importedTimes(folder); }),
              testing::AllOf(HasSubstr("times.txt: has 1 lines, so no time for "),
                             HasSubstr("000001.bin")));
  writeBytes(folder / "times.txt", "");
  EXPECT_THAT(fileErrorOf([&] { importedTimes(folder); }), HasSubstr("times.txt: has 0 lines"));
  fs::remove(folder / "times.txt");
  fs::create_directory(folder / "times.txt");
  EXPECT_THAT(fileErrorOf([&] { importedTimes(folder); }), HasSubstr("times.txt: is a folder"));
}

TEST(ImportSemanticKitti, LeavesNothingBehindWhenItFails) {
  const TempFolder folder;
  writeSequence(folder);
  fs::create_directories(folder / "out");
  SemanticKittiImport request;
  request.folder = folder.path();
  const std::string log = folder / "out/k.rawlog";
  const auto failure = [&] { return fileErrorOf([&] { importSemanticKitti(request, log); }); };
  request.labels = "nowhere";
  EXPECT_THAT(failure(), HasSubstr("nowhere: no such folder of labels"));
  request.labels = "labels";
  writeBytes(folder / "labels/000001.label", "123");
  EXPECT_THAT(failure(), HasSubstr("000001.label"));
  request.labels = "";
  request.selection.first = 2;
  EXPECT_THAT(failure(), HasSubstr("has 2 scans (0 to 1)"));
  request.selection = {};
  writeBytes(folder / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_THAT(failure(), HasSubstr("poses.txt: has 1 poses, so none for"));
  writeBytes(folder / "times.txt", "0.0\nnoon\n");
  EXPECT_THAT(failure(), HasSubstr("times.txt: line 2: 'noon' is no time"));
  EXPECT_TRUE(fs::is_empty(folder / "out"));
}

std::string pcd(const std::string& fields, const std::string& viewpoint, const std::string& rows) {
  const auto columns = 1 + std::count(fields.begin(), fields.end(), ' ');
  std::string sizes, types, counts;
  for (int i = 0; i < columns; ++i) {
    sizes += " 4";
    types += i < 3 ? " F" : " U";
    counts += " 1";
  }
  const auto points = std::to_string(std::count(rows.begin(), rows.end(), '\n'));
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS " + fields + "\nSIZE" + sizes + "\nTYPE" + types +
         "\nCOUNT" + counts + "\nWIDTH " + points + "\nHEIGHT 1\nVIEWPOINT " + viewpoint +
         " 1 0 0 0\nPOINTS " + points + "\nDATA ascii\n" + rows;
}

TEST(ImportPcd, MakesAScanOfEachFileInNaturalOrder) {
  const TempFolder folder;
  for (const int i : {1, 2, 10})
    writeBytes(folder / (std::to_string(i) + ".pcd"),
               pcd("x y z label", "1000000 2 3", "1000001.25 2 3 " + std::to_string(i) + "\n"));
  PcdImport request;
  request.files = {folder.path()};
  EXPECT_EQ(importPcd(request, folder / "a.rawlog").scans, 3u);
  const auto all = observationsOf(folder / "a.rawlog");
  const auto clouds = only<mrpt::obs::CObservationPointCloud>(all);
  ASSERT_EQ(clouds.size(), 3u);
  EXPECT_EQ(intensitiesOf(*clouds[1]), std::vector<float>{2});
  EXPECT_EQ(intensitiesOf(*clouds[2]), std::vector<float>{10});
  float x = 0, y = 0, z = 0;
  clouds[0]->pointcloud->getPoint(0, x, y, z);
  EXPECT_EQ(x, 1.25f) << "relative to the sensor, so that a float holds it";
  const auto poses = only<mrpt::obs::CObservationRobotPose>(all);
  EXPECT_EQ(poses.at(0)->pose.mean, CPose3D(1000000, 2, 3, 0, 0, 0));
}

TEST(ImportPcd, JoinsFilesOfOneSensorPosition) {
  const TempFolder folder;
  writeBytes(folder / "1.pcd", pcd("x y z label", "0 0 0", "1 2 3 4\n"));
  writeBytes(folder / "2.pcd", pcd("x y z label", "0 0 0", "5 6 7 8\n"));
  writeBytes(folder / "3.pcd", pcd("x y z label", "0 0 1", "5 6 7 8\n"));
  PcdImport request;
  request.single_scan = true;
  request.files = {folder / "2.pcd", folder / "1.pcd"};
  const auto summary = importPcd(request, folder / "a.rawlog");
  EXPECT_EQ(summary.scans, 1u);
  EXPECT_EQ(summary.points, 2u);
  const auto clouds = only<mrpt::obs::CObservationPointCloud>(observationsOf(folder / "a.rawlog"));
  EXPECT_THAT(intensitiesOf(*clouds.at(0)), testing::ElementsAre(4, 8));
  request.files.push_back(folder / "3.pcd");
  EXPECT_THROW(importPcd(request, folder / "b.rawlog"), ConfigError);
  EXPECT_FALSE(fs::exists(folder / "b.rawlog"));
}

TEST(ImportPcd, JoinsFilesOfWhichOneIsEmpty) {
  const TempFolder folder;
  writeBytes(folder / "1.pcd", pcd("x y z label", "0 0 0", "1 2 3 4\n"));
  writeBytes(folder / "2.pcd", pcd("x y z label", "0 0 0", ""));
  PcdImport request;
  request.single_scan = true;
  for (const char* field : {"", "label"}) {
    request.label_field = field;
    for (const auto& names : {std::pair("1.pcd", "2.pcd"), std::pair("2.pcd", "1.pcd")}) {
      request.files = {folder / names.first, folder / names.second};
      EXPECT_EQ(importPcd(request, folder / "a.rawlog").points, 1u);
    }
  }
}

TEST(ImportPcd, DoesNotTakeLabelsOfSomeFilesAndNotOfOthers) {
  const TempFolder folder;
  writeBytes(folder / "1.pcd", pcd("x y z label", "0 0 0", "1 2 3 4\n"));
  writeBytes(folder / "2.pcd", pcd("x y z intensity", "0 0 0", "1 2 3 77\n"));
  writeBytes(folder / "3.pcd", pcd("x y z", "0 0 0", "1 2 3\n"));
  PcdImport request;
  for (const bool single : {false, true}) {
    request.single_scan = single;
    for (const char* other : {"2.pcd", "3.pcd"}) {
      request.files = {folder / "1.pcd", folder / other};
      EXPECT_THAT(fileErrorOf([&] { importPcd(request, folder / "a.rawlog"); }),
                  testing::AllOf(HasSubstr(other), HasSubstr("1.pcd has the field 'label'")));
    }
  }
}

TEST(ImportPcd, ChoosesTheFieldThatCarriesLabels) {
  const TempFolder folder;
  writeBytes(folder / "both.pcd", pcd("x y z intensity label", "0 0 0", "1 2 3 77 5\n"));
  writeBytes(folder / "bare.pcd", pcd("x y z", "0 0 0", "1 2 3\n"));
  PcdImport request;
  request.files = {folder / "both.pcd"};
  const auto makeCloud = [&](const std::string& field) {
    request.label_field = field;
    importPcd(request, folder / "a.rawlog");
    return only<mrpt::obs::CObservationPointCloud>(observationsOf(folder / "a.rawlog")).at(0);
  };
  EXPECT_THAT(intensitiesOf(*makeCloud("")), testing::ElementsAre(5));
  EXPECT_THAT(intensitiesOf(*makeCloud("LABEL")), testing::ElementsAre(5));
  EXPECT_THAT(intensitiesOf(*makeCloud("intensity")), testing::ElementsAre(77));
  request.files = {folder / "bare.pcd"};
  EXPECT_EQ(std::dynamic_pointer_cast<mrpt::maps::CPointsMapXYZI>(makeCloud("")->pointcloud),
            nullptr)
      << "points without labels have none, not label 0";
  EXPECT_THROW(makeCloud("label"), FileError);
}

TEST(ImportPcd, ReportsRowsAndLabelsThatItCouldNotKeep) {
  const TempFolder folder;
  writeBytes(folder / "1.pcd", pcd("x y z label", "0 0 0", "1 2 3 4 -1\n5 6 7 16777217\n"));
  writeBytes(folder / "2.pcd", pcd("x y z label", "0 0 0", "1 2 3 4 -1\n"));
  PcdImport request;
  request.row_policy = PcdRowPolicy::Refuse;
  request.files = {folder.path()};
  EXPECT_THAT(fileErrorOf([&] { importPcd(request, folder / "a.rawlog"); }),
              HasSubstr("1.pcd: line 12"));
  request.row_policy = PcdRowPolicy::SkipRow;
  EXPECT_EQ(importPcd(request, folder / "a.rawlog").points, 1u);
  request.row_policy = PcdRowPolicy::IgnoreExtra;
  const auto summary = importPcd(request, folder / "a.rawlog");
  EXPECT_EQ(summary.points, 3u);
  EXPECT_THAT(summary.warnings,
              testing::UnorderedElementsAre(HasSubstr("2 rows with surplus columns, which were "
                                                      "ignored, in this and 1 more files"),
                                            HasSubstr("1 points whose label is above 2^24")));
  const auto clouds = only<mrpt::obs::CObservationPointCloud>(observationsOf(folder / "a.rawlog"));
  EXPECT_EQ(intensitiesOf(*clouds.at(0)).at(1), 4294967296.0f) << "no label set knows this one";
}

/// Two frames, one camera, the second image missing.
void writeDrive(const TempFolder& folder) {
  fs::create_directories(folder / "velodyne_points/data");
  fs::create_directories(folder / "image_02/data");
  fs::create_directories(folder / "calib");
  for (const char* name : {"0000000000.bin", "0000000001.bin"})
    writeBytes(folder / "velodyne_points/data/" + name, scanBytes({{1, 2, 3, 0.5f}}));
  cv::imwrite(folder / "image_02/data/0000000000.png",
              cv::Mat(4, 8, CV_8UC3, cv::Scalar(10, 20, 30)));
  writeBytes(folder / "calib/calib_velo_to_cam.txt", "R: 0 -1 0 0 0 -1 1 0 0\nT: 0 0 0.5\n");
  std::string cameras = "R_rect_00: 1 0 0 0 1 0 0 0 1\n";
  for (const char* n : {"00", "01", "02", "03"})
    cameras += std::string("S_rect_") + n + ": 8 4\nR_rect_" + n + ": 1 0 0 0 1 0 0 0 1\nP_rect_" +
               n + ": 100 0 3.5 0 0 100 1.5 0 0 0 1 0\n";
  writeBytes(folder / "calib/calib_cam_to_cam.txt", cameras);
}

TEST(ImportKittiRaw, WritesScansAndExternalisedImages) {
  const TempFolder folder;
  writeDrive(folder);
  writeBytes(folder / "velodyne_points/timestamps.txt",
             "2011-09-26 13:02:25.500000000\n2011-09-26 13:02:26.000000000\n");
  KittiRawImport request;
  request.folder = folder.path();
  const auto summary = importKittiRaw(request, folder / "r.rawlog");
  EXPECT_EQ(summary.scans, 2u);
  EXPECT_EQ(summary.images, 1u);
  EXPECT_THAT(summary.warnings,
              testing::ElementsAre(testing::AllOf(HasSubstr("image_02: 1 scans have no image"),
                                                  HasSubstr("frame 1"))));

  const auto all = observationsOf(folder / "r.rawlog");
  const auto images = only<mrpt::obs::CObservationImage>(all);
  ASSERT_EQ(images.size(), 1u);
  EXPECT_TRUE(images[0]->image.isExternallyStored());
  EXPECT_EQ(images[0]->image.getWidth(), 8u) << "MRPT finds the file";
  EXPECT_EQ(images[0]->cameraParams.fx(), 100);
  EXPECT_EQ(images[0]->cameraParams.ncols, 8u);
  // The camera looks along the robot's x, half a metre behind the Velodyne.
  const auto ahead = images[0]->cameraPose.composePoint({0, 0, 2.5});
  EXPECT_NEAR(ahead.x, 2.0, 1e-9);
  EXPECT_NEAR(ahead.z, 0.0, 1e-9);
  EXPECT_NEAR(mrpt::Clock::toDouble(images[0]->timestamp), 1317042145.5, 1e-5);
  EXPECT_TRUE(only<mrpt::obs::CObservationRobotPose>(all).empty());
  EXPECT_EQ(surveyRawlog(folder / "r.rawlog").missing_files, 0u);

  EXPECT_THAT(fileErrorOf([&] { importKittiRaw(request, folder / "r.rawlog"); }),
              HasSubstr("r_Images: exists already"));
}

TEST(ImportKittiRaw, EmbedsImages) {
  const TempFolder folder;
  writeDrive(folder);
  KittiRawImport request;
  request.folder = folder.path();
  request.embed_images = true;
  importKittiRaw(request, folder / "r.rawlog");
  const auto images = only<mrpt::obs::CObservationImage>(observationsOf(folder / "r.rawlog"));
  ASSERT_EQ(images.size(), 1u);
  EXPECT_FALSE(images[0]->image.isExternallyStored());
  EXPECT_EQ(images[0]->image.getHeight(), 4u);
  EXPECT_FALSE(fs::exists(folder / "r_Images"));
}

TEST(ImportKittiRaw, LeavesNothingBehindWhenItFails) {
  const TempFolder folder;
  writeDrive(folder);
  writeBytes(folder / "velodyne_points/data/0000000001.bin", "123");
  fs::create_directories(folder / "out");
  KittiRawImport request;
  request.folder = folder.path();
  EXPECT_THROW(importKittiRaw(request, folder / "out/r.rawlog"), FileError);
  EXPECT_TRUE(fs::is_empty(folder / "out"));
}

TEST(ImportKittiRaw, LeavesNoImagesWithoutTheLog) {
  const TempFolder folder;
  writeDrive(folder);
  fs::create_directories(folder / "out");
  KittiRawImport request;
  request.folder = folder.path();
  // A folder that takes the log's place while it is written: the log cannot be committed.
  const auto occupy = [&](std::size_t, std::size_t) {
    fs::create_directories(folder / "out/r.rawlog/occupied");
  };
  EXPECT_THROW(importKittiRaw(request, folder / "out/r.rawlog", occupy), FileError);
  fs::remove_all(folder / "out/r.rawlog");
  EXPECT_TRUE(fs::is_empty(folder / "out"));
}

TEST(ImportKittiRaw, DoesNotTakeOverImagesOfAKilledRun) {
  const TempFolder folder;
  writeDrive(folder);
  const std::string killed = folder / "r_Images.tmp999999999";  // no process has this number
  const std::string running = folder / "r_Images.tmp1";
  fs::create_directories(killed);
  fs::create_directories(running);
  writeBytes(killed + "/stale.png", "stale");
  KittiRawImport request;
  request.folder = folder.path();
  importKittiRaw(request, folder / "r.rawlog");
  EXPECT_FALSE(fs::exists(killed));
  EXPECT_TRUE(fs::exists(running)) << "another import is at work";
  EXPECT_TRUE(fs::exists(folder / "r_Images/image_02_0000000000.png"));
  EXPECT_FALSE(fs::exists(folder / "r_Images/stale.png"));
}

}  // namespace
}  // namespace csom::test
