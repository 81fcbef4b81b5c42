// SPDX-License-Identifier: BSD-3-Clause
// The readers against the real data sets of the folder $CSOM_DATA.
#include <csom/io/KittiReader.h>
#include <csom/io/PcdReader.h>
#include <csom/io/TrajectoryFile.h>

#include <algorithm>

#include "io/IoFixtures.h"

namespace csom::test {
namespace {

class RealData : public testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("CSOM_DATA");
    ASSERT_NE(folder, nullptr) << "set CSOM_DATA to the folder with the data sets";
    data_ = folder;
  }

  /// The .pcd files of a data set.
  std::vector<std::string> clouds(const std::string& name) const {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(data_ + "/" + name))
      if (entry.path().extension() == ".pcd") files.push_back(entry.path().string());
    return files;
  }

  std::string data_;
};

TEST_F(RealData, StanfordRoomIsReadCompletely) {
  const LabelSet labels = LabelSet::load(CSOM_SOURCE_DIR "/config/labels/stanford.yaml");
  std::size_t points = 0;
  for (const std::string& file : clouds("stanford_conference")) {
    const PcdCloud cloud = readPcd(file, PcdRowPolicy::Refuse);
    points += cloud.points.size();
    ASSERT_EQ(cloud.labels.size(), cloud.points.size()) << file;
    for (const std::uint32_t raw : cloud.labels)
      ASSERT_EQ(labels.classOfRaw(raw).kind, LabelSet::RawKind::Class) << file << ": " << raw;
  }
  EXPECT_EQ(points, 531443U);
}

TEST_F(RealData, StructuredRoomIsBinaryAndPadded) {
  const auto files = clouds("sim_structured");
  ASSERT_EQ(files.size(), 12U);
  for (const std::string& file : files) {
    const PcdCloud cloud = readPcd(file, PcdRowPolicy::Refuse);
    ASSERT_EQ(cloud.points.size(), 3500U) << file;
    EXPECT_THAT(cloud.fields, testing::ElementsAre("x", "y", "z", "intensity"));
    EXPECT_TRUE(cloud.labels.empty());
    EXPECT_EQ(readPcd(file, PcdRowPolicy::Refuse, "Intensity").labels.size(), 3500U);
    EXPECT_GT(cloud.viewpoint.norm(), 0.1) << file;
    for (const Eigen::Vector3d& point : cloud.points)
      ASSERT_LT((point - cloud.viewpoint).norm(), 20) << file;
  }
}

TEST_F(RealData, AnnotatedRowsHaveAStrayColumn) {
  const auto files = clouds("sim_unstructured_annotated");
  ASSERT_EQ(files.size(), 12U);
  for (const std::string& file : files) {
    EXPECT_THAT(fileErrorOf([&] { readPcd(file, PcdRowPolicy::Refuse); }),
                testing::HasSubstr("line 12: 5 columns, the header announces 4"));
    const PcdCloud cloud = readPcd(file, PcdRowPolicy::IgnoreExtra);
    EXPECT_GT(cloud.points.size(), 3000U);
    EXPECT_EQ(cloud.irregular_rows, cloud.points.size());
    EXPECT_EQ(cloud.skipped_rows, 0U);
    EXPECT_EQ(cloud.invalid_labels, 0U);
    EXPECT_LT(*std::max_element(cloud.labels.begin(), cloud.labels.end()), 20U);
    EXPECT_EQ(readPcd(file, PcdRowPolicy::SkipRow).skipped_rows, cloud.irregular_rows);
  }
}

TEST_F(RealData, SemanticKittiScansLabelsAndPoses) {
  const LabelSet labels = LabelSet::load(CSOM_SOURCE_DIR "/config/labels/semantickitti.yaml");
  const std::string folder = data_ + "/semantickitti_08/";
  EXPECT_GE(readKittiPoses(folder + "poses.txt").size(), 5U);
  const Eigen::Isometry3d tr = readKittiOdometryCalibration(folder + "calib.txt");
  EXPECT_LT((tr.linear() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitZ()).norm(), 0.02)
      << "the Velodyne looks where the camera looks";
  std::size_t scans = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "velodyne")) {
    const KittiScan scan = readKittiScan(entry.path().string());
    EXPECT_GT(scan.points.size(), 100000U);
    for (const char* kind : {"labels/", "predictions/"}) {
      const auto raw = readKittiLabels(folder + kind + entry.path().stem().string() + ".label",
                                       scan.points.size());
      for (const std::uint32_t id : raw)
        ASSERT_NE(labels.classOfRaw(id).kind, LabelSet::RawKind::Unknown) << id;
    }
    ++scans;
  }
  EXPECT_GE(scans, 5U);
}

TEST_F(RealData, KittiRawCameraSeesTheScan) {
  const std::string folder = data_ + "/kitti_2011_09_26/";
  const KittiCamera camera = readKittiRawCamera(folder + "calib", 2);
  EXPECT_EQ(camera.width, 1242);
  EXPECT_EQ(camera.height, 375);
  EXPECT_NEAR(camera.fx, 721.5377, 1e-3);
  std::string first;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "velodyne_points/data"))
    if (first.empty() || entry.path().string() < first) first = entry.path().string();
  ASSERT_FALSE(first.empty());
  std::size_t inside = 0;
  const KittiScan scan = readKittiScan(first);
  for (const Eigen::Vector3f& point : scan.points) {
    const Eigen::Vector3d p = camera.camera_from_velodyne * point.cast<double>();
    if (p.z() < 0.5) continue;
    const double u = camera.fx * p.x() / p.z() + camera.cx;
    const double v = camera.fy * p.y() / p.z() + camera.cy;
    if (u >= 0 && u < camera.width && v >= 0 && v < camera.height) ++inside;
  }
  // The camera sees about 81° of the scanner's 360°.
  EXPECT_GT(static_cast<double>(inside) / static_cast<double>(scan.points.size()), 0.1);
  EXPECT_LT(static_cast<double>(inside) / static_cast<double>(scan.points.size()), 0.3);
}

}  // namespace
}  // namespace csom::test
