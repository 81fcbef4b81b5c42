// SPDX-License-Identifier: BSD-3-Clause
#include <csom/protocols/StreetProtocol.h>
#include <gmock/gmock.h>

#include <cstring>
#include <filesystem>

#include "protocols/SmallInputs.h"

namespace csom {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

template <class T>
std::string bytesOf(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

/// Two scans of three points, the second one 2 m further along the camera's z axis, which is the
/// Velodyne's x axis.
class StreetFolder {
 public:
  StreetFolder() {
    for (const char* name : {"velodyne", "labels", "predictions"})
      std::filesystem::create_directory(folder_ / name);
    test::writeBytes(folder_ / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 2\n");
    test::writeBytes(folder_ / "calib.txt", "Tr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n");
    const std::vector<float> points{5.1f, 0.1f, 0.1f, 0, 8.1f, 0.1f, 0.1f, 0, 9.1f, 3.1f, 0.1f, 0};
    for (const char* scan : {"000000", "000001"})
      test::writeBytes(folder_ / ("velodyne/" + std::string(scan) + ".bin"), bytesOf(points));
    // Moving car, road, unlabelled; instance numbers in the upper bits.
    writeLabels("labels", "000000", {252u | 7u << 16, 40, 0});
    writeLabels("labels", "000001", {10, 40, 70});
    writeLabels("predictions", "000000", {10, 44, 50});
    writeLabels("predictions", "000001", {10, 40, 0});
  }

  void writeLabels(const std::string& kind, const std::string& scan,
                   const std::vector<std::uint32_t>& labels) const {
    test::writeBytes(folder_ / (kind + "/" + scan + ".label"), bytesOf(labels));
  }
  const std::string& path() const { return folder_.path(); }
  std::string operator/(const std::string& name) const { return folder_ / name; }

 private:
  test::TempFolder folder_;
};

TEST(StreetProtocol, ReadsPosesLabelsAndPredictions) {
  const StreetFolder folder;
  const Street street = readStreet(folder.path(), test::labelsOf("semantickitti"));
  ASSERT_EQ(street.scans.size(), 2U);
  EXPECT_THAT(street.scans[0].labels, ElementsAre(1, 9, kFreeClass));
  EXPECT_THAT(street.scans[1].predictions, ElementsAre(1, 9, kFreeClass));
  EXPECT_TRUE(street.scans[1].origin.isApprox(Eigen::Vector3d(0, 0, 2)));
  EXPECT_TRUE(street.scans[1].points[0].isApprox(Eigen::Vector3d(-0.1, -0.1, 7.1), 1e-6));
  EXPECT_THAT(street.warnings, IsEmpty());
}

TEST(StreetProtocol, MapsPredictionsOfEverySecondScanAgainstLabelsOfAll) {
  const StreetFolder folder;
  const Street street = readStreet(folder.path(), test::labelsOf("semantickitti"));
  const Trial trial = streetTrials(street, 2, 0, 0.5).front();
  ASSERT_EQ(trial.scans->size(), 1U);
  EXPECT_THAT(trial.scans->front().labels, ElementsAre(1, 10, 13));
  // The scan's third point has no true label: whatever is there is left out.
  EXPECT_FALSE(trial.truth->at({-7, -1, 18}));

  const TrialResult result = runTrial(trial, MethodSpec::parse("s-csm")).front();
  EXPECT_DOUBLE_EQ(result.voxels.score.iou(1), 0.5);  // the second scan's car was not mapped
  EXPECT_DOUBLE_EQ(result.voxels.score.iou(9), 0);
  EXPECT_EQ(result.voxels.score.confusion(9, 10), 1U);
  EXPECT_EQ(result.voxels.score.predictedCount(13), 0U);
  ASSERT_TRUE(result.points);
  EXPECT_EQ(result.points->points(), 5U);
  EXPECT_DOUBLE_EQ(result.points->accuracy(), 1.0 / 5);
  EXPECT_DOUBLE_EQ(result.points->coverage(), 2.0 / 5);
}

TEST(StreetProtocol, TheInputsOwnLabelsAreScored) {
  const StreetFolder folder;
  const PointScore score =
      scoreOfPredictions(readStreet(folder.path(), test::labelsOf("semantickitti")));
  EXPECT_EQ(score.points(), 5U);
  EXPECT_DOUBLE_EQ(score.accuracy(), 3.0 / 5);
  EXPECT_DOUBLE_EQ(score.meanIou(), (1 + 0.5 + 0) / 3);  // car, road, vegetation
}

TEST(StreetProtocol, UnknownLabelsAreWarnedOf) {
  const StreetFolder folder;
  folder.writeLabels("predictions", "000001", {10, 5000, 5000});
  const Street street = readStreet(folder.path(), test::labelsOf("semantickitti"));
  EXPECT_THAT(street.warnings, ElementsAre(HasSubstr("did not use 2 labels")));
}

TEST(StreetProtocol, MissingFilesAreNamed) {
  const auto labels = test::labelsOf("semantickitti");
  const StreetFolder folder;
  std::filesystem::remove(folder / "predictions/000001.label");
  EXPECT_THAT(test::fileErrorOf([&] { readStreet(folder.path(), labels); }),
              HasSubstr("predictions/000001.label"));
  const StreetFolder short_of_poses;
  test::writeBytes(short_of_poses / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_THAT(test::fileErrorOf([&] { readStreet(short_of_poses.path(), labels); }),
              HasSubstr("has 1 poses, so none for"));
}

}  // namespace
}  // namespace csom
