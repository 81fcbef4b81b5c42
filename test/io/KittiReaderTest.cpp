// SPDX-License-Identifier: BSD-3-Clause
#include <csom/io/KittiReader.h>

#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class KittiReaderTest : public testing::Test {
 protected:
  TempFolder folder_;
};

TEST_F(KittiReaderTest, ReadsScans) {
  std::string bytes;
  for (const float value : {1.F, -2.F, 3.5F, 0.25F, 4.F, 5.F, 6.F, 1.F}) bytes += bytesOf(value);
  writeBytes(folder_ / "000000.bin", bytes);
  const KittiScan scan = readKittiScan(folder_ / "000000.bin");
  EXPECT_THAT(scan.points, ElementsAre(Eigen::Vector3f(1, -2, 3.5F), Eigen::Vector3f(4, 5, 6)));
  EXPECT_THAT(scan.intensities, ElementsAre(0.25F, 1.F));
}

TEST_F(KittiReaderTest, EmptyScanHasNoPoints) {
  writeBytes(folder_ / "0.bin", "");
  EXPECT_TRUE(readKittiScan(folder_ / "0.bin").points.empty());
}

TEST_F(KittiReaderTest, ScanOfBrokenSizeIsRefused) {
  writeBytes(folder_ / "0.bin", std::string(33, '\0'));
  EXPECT_THAT(fileErrorOf([&] { readKittiScan(folder_ / "0.bin"); }),
              HasSubstr("0.bin: 33 bytes are not a whole number of points of 16 bytes"));
}

TEST_F(KittiReaderTest, LabelsAreTheLowHalf) {
  writeBytes(folder_ / "0.label",
             bytesOf(std::uint32_t{40}) + bytesOf(std::uint32_t{(123U << 16U) | 252U}));
  EXPECT_THAT(readKittiLabels(folder_ / "0.label", 2), ElementsAre(40, 252));
}

TEST_F(KittiReaderTest, LabelsMustMatchTheScan) {
  writeBytes(folder_ / "0.label", std::string(8, '\0'));
  for (const std::size_t points : {0U, 1U, 3U})
    EXPECT_THAT(fileErrorOf([&] { readKittiLabels(folder_ / "0.label", points); }),
                HasSubstr("8 bytes, but the scan's " + std::to_string(points) + " points"));
  writeBytes(folder_ / "1.label", std::string(9, '\0'));
  fileErrorOf([&] { readKittiLabels(folder_ / "1.label", 2); });
}

TEST_F(KittiReaderTest, OdometryCalibration) {
  writeBytes(folder_ / "calib.txt",
             "P0: 7 0 6 0 0 7 1 0 0 0 1 0\nTr: 0 -1 0 0.5 0 0 -1 -0.25 1 0 0 -1.5\n");
  const Eigen::Isometry3d tr = readKittiOdometryCalibration(folder_ / "calib.txt");
  EXPECT_TRUE((tr * Eigen::Vector3d(10, 2, 3)).isApprox(Eigen::Vector3d(-1.5, -3.25, 8.5)));
}

TEST_F(KittiReaderTest, BadCalibrationsNameTheLine) {
  const auto error = [&](const std::string& text) {
    writeBytes(folder_ / "calib.txt", text);
    return fileErrorOf([&] { readKittiOdometryCalibration(folder_ / "calib.txt"); });
  };
  EXPECT_THAT(error("P0: 1 2 3\n"), HasSubstr("calib.txt: has no line 'Tr:'"));
  EXPECT_THAT(error("a: 1\nTr: 1 2 3\n"), HasSubstr("line 2 ('Tr:'): 3 numbers, expected 12"));
  EXPECT_THAT(error("Tr: 1 0 0 0 0 1 0 0 0 0 x 0\n"), HasSubstr("'x' is not a finite number"));
  EXPECT_THAT(error("Tr: 1 0 0 nan 0 1 0 0 0 0 1 0\n"), HasSubstr("'nan' is not a finite"));
  EXPECT_THAT(error("Tr: 2 0 0 0 0 1 0 0 0 0 1 0\n"), HasSubstr("not a rotation"));
  EXPECT_THAT(error("Tr: -1 0 0 0 0 1 0 0 0 0 1 0\n"), HasSubstr("not a rotation")) << "mirrored";
}

class KittiRawTest : public KittiReaderTest {
 protected:
  void writeCalibration(const std::string& projection) const {
    writeBytes(folder_ / "calib_velo_to_cam.txt",
               "calib_time: 15-Mar-2012 11:37:16\nR: 0 -1 0 0 0 -1 1 0 0\nT: 0.1 -0.2 -0.3\n");
    // R_rect_00: a turn about the optical axis by 90°.
    writeBytes(folder_ / "calib_cam_to_cam.txt",
               "S_rect_02: 1.242e+03 3.75e+02\nR_rect_00: 0 -1 0 1 0 0 0 0 1\nP_rect_02: " +
                   projection + "\n");
  }
};

TEST_F(KittiRawTest, ProjectsAsTheMatricesDo) {
  writeCalibration("700 0 600 45 0 710 170 0.5 0 0 1 0.003");
  const KittiCamera camera = readKittiRawCamera(folder_.path(), 2);
  EXPECT_EQ(camera.width, 1242);
  EXPECT_EQ(camera.height, 375);

  Eigen::Matrix4d velo = Eigen::Matrix4d::Identity();
  velo.topRows<3>() << 0, -1, 0, 0.1, 0, 0, -1, -0.2, 1, 0, 0, -0.3;
  Eigen::Matrix4d rectify = Eigen::Matrix4d::Identity();
  rectify.topLeftCorner<3, 3>() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  Eigen::Matrix<double, 3, 4> projection;
  projection << 700, 0, 600, 45, 0, 710, 170, 0.5, 0, 0, 1, 0.003;
  const Eigen::Vector4d point(12, 1.5, -0.7, 1);
  const Eigen::Vector3d expected = projection * rectify * velo * point;
  const Eigen::Vector3d found = camera.camera_from_velodyne * Eigen::Vector3d(point.head<3>());
  EXPECT_NEAR(camera.fx * found.x() / found.z() + camera.cx, expected.x() / expected.z(), 1e-9);
  EXPECT_NEAR(camera.fy * found.y() / found.z() + camera.cy, expected.y() / expected.z(), 1e-9);
}

TEST_F(KittiRawTest, RefusesWhatIsNoCamera) {
  const auto error = [&](int camera) {
    return fileErrorOf([&] { readKittiRawCamera(folder_.path(), camera); });
  };
  writeCalibration("700 1 600 45 0 710 170 0.5 0 0 1 0");
  EXPECT_THAT(error(2), HasSubstr("line 3 ('P_rect_02:'): not the projection"));
  writeCalibration("0 0 600 45 0 710 170 0.5 0 0 1 0");
  EXPECT_THAT(error(2), HasSubstr("not the projection"));
  EXPECT_THAT(error(3), HasSubstr("has no line 'P_rect_03:'"));
  EXPECT_THROW(readKittiRawCamera(folder_.path(), 4), std::invalid_argument);
  EXPECT_THAT(fileErrorOf([] { readKittiRawCamera("/nowhere", 2); }),
              HasSubstr("/nowhere/calib_velo_to_cam.txt: no such file"));
}

}  // namespace
}  // namespace csom::test
