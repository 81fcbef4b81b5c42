// SPDX-License-Identifier: BSD-3-Clause
#include <csom/protocols/StreetProtocol.h>
#include <gmock/gmock.h>

#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

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

/// A scan of points along the x axis, seen from the origin.
StreetScan scanAlongX(const std::vector<std::pair<double, ClassId>>& ranges) {
  StreetScan scan;
  for (const auto& [range, label] : ranges) {
    scan.points.emplace_back(range, 0.1, 0.1);
    scan.labels.push_back(label);
    scan.predictions.push_back(label);
  }
  return scan;
}

TEST(StreetProtocol, P7KnowsWhatPointsAndTwoSamplesOfBeamsTell) {
  Street street;
  street.labels = test::labelsOf("semantickitti");
  // Voxels of 1 m; samples at 1.5, 2.3, 3.1, 3.9, 4.7, 5.5, 6.3 … of each beam.
  street.scans = {scanAlongX({{4.5, 1}, {6.4, kFreeClass}}), scanAlongX({{4.6, 9}, {4.7, 9}}),
                  scanAlongX({{9.5, 1}, {51, 9}})};
  const VoxelTruth truth = computeStreetTruth(street, 1);
  EXPECT_EQ(truth.at({4, 0, 0}), 9);           // the majority
  EXPECT_FALSE(truth.at({6, 0, 0}));           // holds a point without a label
  EXPECT_EQ(truth.at({2, 0, 0}), kFreeClass);  // crossed by all beams
  EXPECT_FALSE(truth.at({5, 0, 0}));           // crossed by one, which has one sample there
  EXPECT_EQ(truth.at({7, 0, 0}), kFreeClass);  // by one, which has two (7.1, 7.9)
  EXPECT_FALSE(truth.at({8, 0, 0}));           // 8.7: less than a voxel before the point
  EXPECT_EQ(truth.at({9, 0, 0}), 1);
  EXPECT_FALSE(truth.at({20, 0, 0}));  // the beam that ends beyond 50 m tells nothing
  EXPECT_FALSE(truth.at({51, 0, 0}));
  EXPECT_FALSE(truth.at({2, 3, 0}));
  EXPECT_TRUE(truth.knowsFree());
}

TEST(StreetProtocol, P7MapsTheFirstAndTheLastScan) {
  Street street;
  street.labels = test::labelsOf("semantickitti");
  street.scans = {scanAlongX({{4.5, 1}}), scanAlongX({{9.5, 1}}), scanAlongX({{9.5, 9}})};
  const Trial trial = knownStreetTrials(street, 0, 1).front();
  ASSERT_EQ(trial.scans->size(), 2U);
  EXPECT_THAT(trial.scans->back().labels, ElementsAre(9));
  const TrialResult result = runTrial(trial, MethodSpec::parse("s-csm")).front();
  EXPECT_DOUBLE_EQ(result.voxels.score.iou(1), 0.5);  // class 1 is what both voxels are (ties)
  EXPECT_GT(result.voxels.known_free_iou, 0);         // beams are cast
  EXPECT_EQ(result.points->points(), 3U);
}

}  // namespace
}  // namespace csom
