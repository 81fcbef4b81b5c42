// SPDX-License-Identifier: BSD-3-Clause
// Images and scans find each other in whatever order they come, and what cannot be used is said.
#include <csom/core/Error.h>
#include <csom/maps/CSemanticContinuousMap.h>
#include <csom/maps/PoseRounding.h>
#include <gmock/gmock.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationStereoImages.h>
#include <mrpt/serialization/CArchive.h>

#include <fstream>
#include <string>
#include <vector>

#include "CameraLabelledAdapter.h"
#include "SampleObservations.h"

namespace csom {
namespace {

using mrpt::obs::CObservationImage;
using mrpt::poses::CPose3D;
using sample::pointCloud;
using sample::sampleLabels;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kStart = 1500000000;
constexpr int kWidth = 100;
constexpr int kHeight = 80;
constexpr std::uint8_t kRoadId = 40;
constexpr std::uint8_t kWallId = 50;
constexpr ClassId kRoad = 1;
constexpr ClassId kWall = 2;
constexpr ClassId kUnlabelled = 3;

mrpt::img::TCamera calibration() {
  mrpt::img::TCamera camera;
  camera.ncols = kWidth;
  camera.nrows = kHeight;
  camera.setIntrinsicParamsFromValues(50, 50, (kWidth - 1) / 2.0, (kHeight - 1) / 2.0);
  return camera;
}

/// Raw ids: `left` in the left half, `right` in the right half. The camera looks along the robot's
/// x axis.
CObservationImage::Ptr labelImage(double time, std::uint8_t left = kRoadId,
                                  std::uint8_t right = kWallId) {
  auto observation = CObservationImage::Create();
  observation->sensorLabel = "ids";
  observation->timestamp = mrpt::Clock::fromDouble(kStart + time);
  observation->cameraParams = calibration();
  observation->cameraPose = CPose3D(0, 0, 0, -M_PI / 2, 0, -M_PI / 2);
  observation->image = mrpt::img::CImage(kWidth, kHeight, mrpt::img::CH_GRAY);
  for (unsigned v = 0; v < kHeight; ++v) {
    auto* row = observation->image.ptrLine<std::uint8_t>(v);
    std::fill(row, row + kWidth / 2, left);
    std::fill(row + kWidth / 2, row + kWidth, right);
  }
  return observation;
}

/// A point to the left of the camera's axis and one to the right, 5 m ahead.
mrpt::obs::CObservationPointCloud::Ptr scanAt(double time,
                                              const std::vector<Eigen::Vector3f>& points = {
                                                  {5, 1, 0}, {5, -1, 0}}) {
  auto scan = pointCloud(points, std::vector<float>(points.size(), 50));
  scan->timestamp = mrpt::Clock::fromDouble(kStart + time);
  return scan;
}

LabelOptions cameraOptions() {
  LabelOptions options;
  LabelSource camera;
  camera.sensor_label = "camera";
  camera.kind = LabelSource::Kind::LabelImage;
  camera.label_image = "ids";
  options.sources = {camera};
  options.max_time_offset = 0.1;
  options.points.edge_margin = 0;
  options.outside_view = OutsideView::Drop;
  return options;
}

class CameraLabelledAdapterTest : public testing::Test {
 protected:
  /// The scans that are complete now.
  std::vector<AdaptedScan> give(const mrpt::obs::CObservation& observation,
                                const CPose3D& robot = {}) {
    auto scans = adapter_.adapt(observation, roundedPose(robot), rules_);
    if (!scans) throw std::logic_error("not taken");
    return *scans;
  }
  const CameraStatistics& statistics() const { return *adapter_.cameraStatistics(); }

  LabelSet labels_ = sampleLabels();
  LabelRules rules_{labels_, PointLabels::ByIntensity, "drop", ""};
  CameraLabelledAdapter adapter_{cameraOptions(), labels_};
};

TEST_F(CameraLabelledAdapterTest, PointsTakeTheClassOfTheirPixel) {
  EXPECT_TRUE(give(*labelImage(0)).empty());
  const auto scans = give(*scanAt(0));
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_THAT(scans[0].scan.labels, ElementsAre(kRoad, kWall));
  EXPECT_EQ(scans[0].sensor_label, "cloud");
  EXPECT_EQ(scans[0].observation_class, "CObservationPointCloud");
  EXPECT_DOUBLE_EQ(scans[0].timestamp, kStart);
  EXPECT_EQ(statistics().scans.labelled, 1U);
  EXPECT_EQ(statistics().cameras[0].images.used, 1U);
}

TEST_F(CameraLabelledAdapterTest, AnImageMayComeAfterItsScan) {
  EXPECT_TRUE(give(*scanAt(0)).empty());
  const auto scans = give(*labelImage(0));
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_THAT(scans[0].scan.labels, ElementsAre(kRoad, kWall));
}

TEST_F(CameraLabelledAdapterTest, TheImageNearestInTimeCounts) {
  give(*labelImage(-0.05, kWallId, kWallId));
  EXPECT_TRUE(give(*scanAt(0)).empty()) << "a nearer image may still come";
  const auto scans = give(*labelImage(0.03));
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_THAT(scans[0].scan.labels, ElementsAre(kRoad, kWall));

  give(*labelImage(1.0, kRoadId, kRoadId));
  give(*scanAt(1.04));
  const auto nearer_before = give(*labelImage(1.09));
  ASSERT_EQ(nearer_before.size(), 1U);
  EXPECT_THAT(nearer_before[0].scan.labels, ElementsAre(kRoad, kRoad));
}

TEST_F(CameraLabelledAdapterTest, ScansBetweenImagesKeepTheirOrder) {
  std::vector<AdaptedScan> all;
  const auto take = [&](std::vector<AdaptedScan> scans) {
    for (AdaptedScan& scan : scans) all.push_back(std::move(scan));
  };
  take(give(*scanAt(0.00)));
  take(give(*scanAt(0.02)));
  take(give(*labelImage(0.03)));
  take(give(*scanAt(0.04)));
  take(give(*scanAt(0.06)));
  take(give(*labelImage(0.07)));
  ASSERT_EQ(all.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(all[i].timestamp - kStart, 0.02 * static_cast<double>(i), 1e-6);
    EXPECT_THAT(all[i].scan.labels, ElementsAre(kRoad, kWall));
  }
}

TEST_F(CameraLabelledAdapterTest, AScanWhoseImageIsMissingGivesUpWhenTimeHasPassed) {
  EXPECT_TRUE(give(*scanAt(0)).empty());
  EXPECT_TRUE(give(*scanAt(0.1)).empty()) << "an image of 0.1 s would still do";
  const auto scans = give(*scanAt(0.15));
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_TRUE(scans[0].scan.points.empty());
  EXPECT_EQ(statistics().scans.without_image, 1U);
  EXPECT_EQ(statistics().points.outside_view, 2U);
  EXPECT_EQ(statistics().points.dropped(), 2U);
}

TEST_F(CameraLabelledAdapterTest, FlushFinishesWhatWaits) {
  give(*labelImage(-0.05));
  give(*scanAt(0));
  const auto scans = adapter_.flush();
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_THAT(scans[0].scan.labels, ElementsAre(kRoad, kWall));
  EXPECT_TRUE(adapter_.flush().empty());
}

TEST_F(CameraLabelledAdapterTest, TheRobotMovesBetweenImageAndScan) {
  give(*labelImage(0));
  // 1.5 m to the left, 0.05 s later: both points are on the left of where the camera was.
  EXPECT_TRUE(give(*scanAt(0.05), CPose3D(0, 1.5, 0, 0, 0, 0)).empty());
  const auto scans = adapter_.flush();
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_THAT(scans[0].scan.labels, ElementsAre(kRoad, kRoad));
  EXPECT_DOUBLE_EQ(scans[0].scan.origin.y(), 1.5);
}

TEST_F(CameraLabelledAdapterTest, PointsThatNoCameraSeesAreDroppedOrUnlabelled) {
  const auto behind = scanAt(0, {{5, 1, 0}, {-5, 0, 0}});
  give(*labelImage(0));
  const auto dropped = give(*behind);
  ASSERT_EQ(dropped.size(), 1U);
  EXPECT_THAT(dropped[0].scan.labels, ElementsAre(kRoad));

  LabelOptions options = cameraOptions();
  options.outside_view = OutsideView::Unlabelled;
  CameraLabelledAdapter keeping(options, labels_);
  keeping.adapt(*labelImage(0), roundedPose({}), rules_);
  const auto kept = keeping.adapt(*behind, roundedPose({}), rules_);
  ASSERT_EQ(kept->size(), 1U);
  EXPECT_THAT(kept->front().scan.labels, ElementsAre(kRoad, kUnlabelled));
  EXPECT_EQ(keeping.cameraStatistics()->points.kept_unlabelled, 1U);
  EXPECT_EQ(keeping.cameraStatistics()->points.dropped(), 0U);
}

TEST_F(CameraLabelledAdapterTest, A1_pointsOnPixelsWithoutAClassAreObstaclesTooIfThoseOutsideAre) {
  constexpr std::uint8_t kIgnored = 0;
  constexpr std::uint8_t kUnknown = 99;
  LabelOptions options = cameraOptions();
  options.outside_view = OutsideView::Unlabelled;
  CameraLabelledAdapter keeping(options, labels_);
  keeping.adapt(*labelImage(0, kIgnored, kUnknown), roundedPose({}), rules_);
  const auto kept = keeping.adapt(*scanAt(0), roundedPose({}), rules_);
  ASSERT_EQ(kept->size(), 1U);
  EXPECT_THAT(kept->front().scan.labels, ElementsAre(kUnlabelled, kUnlabelled));
  EXPECT_EQ(keeping.cameraStatistics()->points.dropped(), 0U);
  EXPECT_EQ(keeping.cameraStatistics()->points.rejected(), 0U);

  give(*labelImage(0, kIgnored, kUnknown));
  EXPECT_TRUE(give(*scanAt(0)).front().scan.labels.empty());
  EXPECT_EQ(statistics().points.rejected(), 2U);
}

TEST_F(CameraLabelledAdapterTest, A8_itTellsWhichWayTheCameraLooks) {
  give(*labelImage(0));
  const auto& axis = statistics().cameras[0].looks_along;
  EXPECT_NEAR(axis[0], 1, 1e-9);
  EXPECT_NEAR(axis[1], 0, 1e-9);
  EXPECT_NEAR(axis[2], 0, 1e-9);
}

TEST_F(CameraLabelledAdapterTest, B9_assigningAMapKeepsTheObserverOfTheOneThatIsAssignedTo) {
  CSemanticContinuousMap source({}, labels_);
  CSemanticContinuousMap target({}, labels_);
  source.labelOptions = target.labelOptions = cameraOptions();
  int seen_by_source = 0, seen_by_target = 0;
  source.setLabelledScanObserver([&](const LabelledScan&) { ++seen_by_source; });
  target.setLabelledScanObserver([&](const LabelledScan&) { ++seen_by_target; });
  source.insertObservation(*labelImage(0));
  target = source;
  target.insertObservation(*scanAt(0));
  EXPECT_EQ(seen_by_target, 1);
  EXPECT_EQ(seen_by_source, 0);
  CSemanticContinuousMap copy(source);
  copy.insertObservation(*scanAt(0));
  EXPECT_EQ(seen_by_source, 0) << "a copy has no observer";
  source.insertObservation(*scanAt(0));
  EXPECT_EQ(seen_by_source, 1);
  EXPECT_EQ(seen_by_target, 1);
}

TEST_F(CameraLabelledAdapterTest, PixelsThatTheLabelSetIgnoresOrDoesNotKnowAreCounted) {
  give(*labelImage(0, 0, 77));
  const auto scans = give(*scanAt(0));
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_TRUE(scans[0].scan.points.empty());
  EXPECT_EQ(statistics().points.ignored, 1U);
  EXPECT_EQ(statistics().points.unknown, 1U);
}

TEST_F(CameraLabelledAdapterTest, ARangeCameraLabelsItsOwnPointsFromItsOwnImage) {
  LabelOptions options = cameraOptions();
  options.sources[0].label_image = "kinect";
  CameraLabelledAdapter adapter(options, labels_);
  mrpt::obs::CObservation3DRangeScan scan;
  scan.sensorLabel = "kinect";
  scan.timestamp = mrpt::Clock::fromDouble(kStart);
  scan.hasPoints3D = true;
  scan.points3D_x = {5, 5};
  scan.points3D_y = {1, -1};
  scan.points3D_z = {0, 0};
  scan.hasIntensityImage = true;
  scan.intensityImage = labelImage(0)->image;
  scan.cameraParamsIntensity = calibration();
  scan.relativePoseIntensityWRTDepth = CPose3D(0, 0, 0, -M_PI / 2, 0, -M_PI / 2);
  const auto scans = adapter.adapt(scan, roundedPose({}), rules_);
  ASSERT_TRUE(scans && scans->size() == 1U);
  EXPECT_THAT(scans->front().scan.labels, ElementsAre(kRoad, kWall));
}

TEST_F(CameraLabelledAdapterTest, SensorsThatLabelThemselvesNeedNoCamera) {
  LabelOptions options = cameraOptions();
  LabelSource self;
  self.sensor_label = "cloud";
  self.kind = LabelSource::Kind::PointLabels;
  options.sources.push_back(self);
  CameraLabelledAdapter adapter(options, labels_);
  const auto scans = adapter.adapt(*scanAt(0), roundedPose({}), rules_);
  ASSERT_TRUE(scans && scans->size() == 1U);
  EXPECT_THAT(scans->front().scan.labels, ElementsAre(kWall, kWall)) << "by intensity";
}

TEST_F(CameraLabelledAdapterTest, OtherImagesAndKindsAreNotTaken) {
  auto other = labelImage(0);
  other->sensorLabel = "another camera";
  EXPECT_FALSE(adapter_.adapt(*other, roundedPose({}), rules_));
  EXPECT_FALSE(adapter_.adapt(mrpt::obs::CObservationOdometry(), roundedPose({}), rules_));
}

TEST_F(CameraLabelledAdapterTest, TheObserverReceivesThePhotoInEitherOrder) {
  std::vector<LabelledScan> seen;
  adapter_.setObserver([&](const LabelledScan& scan) { seen.push_back(scan); });
  for (const bool photo_first : {true, false}) {
    const double time = photo_first ? 0 : 1;
    auto photo = labelImage(time);
    photo->sensorLabel = "camera";
    photo->image = mrpt::img::CImage(kWidth, kHeight, mrpt::img::CH_RGB);
    if (photo_first) give(*photo);
    give(*labelImage(time));
    if (!photo_first) give(*photo);
    give(*scanAt(time));
  }
  ASSERT_EQ(seen.size(), 2U);
  for (const LabelledScan& scan : seen) {
    ASSERT_EQ(scan.views.size(), 1U);
    EXPECT_EQ(scan.views[0].photo.type(), CV_8UC3);
    EXPECT_EQ(scan.views[0].sensor_label, "camera");
    EXPECT_EQ(scan.labelled.counts()[static_cast<std::size_t>(PointFate::Labelled)], 2U);
  }
}

// Damaged images.

class DamagedImageTest : public CameraLabelledAdapterTest {
 protected:
  std::string reasonOf(const mrpt::obs::CObservation& observation) {
    try {
      give(observation);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "no error";
  }
};

TEST_F(DamagedImageTest, ACameraWithoutCalibration) {
  auto image = labelImage(0);
  image->cameraParams = mrpt::img::TCamera();
  EXPECT_THAT(reasonOf(*image), HasSubstr("not calibrated"));
  EXPECT_EQ(statistics().cameras[0].images.read, 1U);
  EXPECT_EQ(statistics().cameras[0].images.refused, 1U);
}

TEST_F(DamagedImageTest, AnImageOfAnotherSizeThanItsCalibration) {
  auto image = labelImage(0);
  image->cameraParams.ncols = 640;
  image->cameraParams.nrows = 480;
  EXPECT_THAT(reasonOf(*image), HasSubstr("100 x 80 pixels, but its calibration is for 640 x 480"));
}

TEST_F(DamagedImageTest, AFileThatIsMissingOrCorrupt) {
  auto image = labelImage(0);
  image->image = mrpt::img::CImage();
  image->image.setExternalStorage("/nowhere/image.jpg");
  EXPECT_THAT(reasonOf(*image), HasSubstr("missing or damaged: /nowhere/image.jpg"));

  const std::string corrupt = testing::TempDir() + "corrupt.jpg";
  std::ofstream(corrupt) << "\xff\xd8\xff\xe0 no JPEG";
  image->image.setExternalStorage(corrupt);
  EXPECT_THAT(reasonOf(*image), HasSubstr("missing or damaged: " + corrupt));

  image->image = mrpt::img::CImage();
  EXPECT_THAT(reasonOf(*image), HasSubstr("holds no image"));
}

TEST_F(DamagedImageTest, ColoursWhereIdsAreExpected) {
  auto image = labelImage(0);
  image->image = mrpt::img::CImage(kWidth, kHeight, mrpt::img::CH_RGB);
  EXPECT_THAT(reasonOf(*image), HasSubstr("colours, not the gray values"));
}

TEST_F(DamagedImageTest, NoTimeStamp) {
  auto image = labelImage(0);
  image->timestamp = INVALID_TIMESTAMP;
  EXPECT_THAT(reasonOf(*image), HasSubstr("no time stamp"));
  auto scan = scanAt(0);
  scan->timestamp = INVALID_TIMESTAMP;
  EXPECT_THAT(reasonOf(*scan), HasSubstr("no time stamp"));
}

TEST_F(DamagedImageTest, TwoCamerasWithTheSameLabel) {
  give(*labelImage(0));
  EXPECT_THAT(reasonOf(*labelImage(0, kWallId, kWallId)), HasSubstr("another image"));
  EXPECT_EQ(statistics().cameras[0].images.refused, 1U);
  const auto scans = give(*scanAt(0));
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_THAT(scans[0].scan.labels, ElementsAre(kRoad, kWall)) << "the first one counts";
}

TEST_F(DamagedImageTest, ACalibrationThatCannotBe) {
  auto image = labelImage(0);
  image->cameraParams.intrinsicParams(0, 2) = std::nan("");
  EXPECT_NE(reasonOf(*image), "no error");
}

// Time that goes back.

TEST_F(CameraLabelledAdapterTest, SlightDisorderIsSorted) {
  give(*labelImage(0.05, kWallId, kWallId));
  give(*labelImage(0.0));
  const auto scans = give(*scanAt(0.01));
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_THAT(scans[0].scan.labels, ElementsAre(kRoad, kWall));
  EXPECT_EQ(statistics().clock_restarts, 0U);
}

TEST_F(CameraLabelledAdapterTest, TimeMayBeginAtZero) {
  auto image = labelImage(0);
  auto scan = scanAt(0);
  image->timestamp = scan->timestamp = mrpt::Clock::fromDouble(0);
  give(*image);
  EXPECT_EQ(give(*scan).size(), 1U);
}

TEST_F(CameraLabelledAdapterTest, AClockThatGoesBackStartsAnew) {
  give(*labelImage(100, kWallId, kWallId));
  give(*scanAt(100.02));
  const auto finished = give(*labelImage(0));
  ASSERT_EQ(finished.size(), 1U) << "what waited is labelled with what there was";
  EXPECT_THAT(finished[0].scan.labels, ElementsAre(kWall, kWall));
  EXPECT_EQ(statistics().clock_restarts, 1U);
  EXPECT_TRUE(give(*scanAt(0.02)).empty()) << "waits as at the beginning";
  const auto scans = give(*labelImage(0.02));
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_THAT(scans[0].scan.labels, ElementsAre(kRoad, kWall));
}

TEST_F(CameraLabelledAdapterTest, AScanThatComesLateIsCounted) {
  for (int i = 0; i <= 50; ++i) give(*labelImage(0.1 * i));
  // Earlier than now, but not by so much that the clock must have been set back.
  const auto scans = give(*scanAt(4.2));
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_THAT(scans[0].scan.labels, ElementsAre(kRoad, kWall)) << "its image is still there";
  EXPECT_EQ(statistics().scans.late, 0U);

  for (int i = 1; i <= 200; ++i) give(*labelImage(5 + 0.02 * i));
  const auto late = give(*scanAt(8.1));
  ASSERT_EQ(late.size(), 1U);
  EXPECT_TRUE(late[0].scan.points.empty()) << "so many images have come since";
  EXPECT_EQ(statistics().scans.late, 1U);
}

TEST_F(CameraLabelledAdapterTest, NoMoreThanSixtyFourScansWait) {
  LabelOptions options = cameraOptions();
  options.max_time_offset = 3600;
  CameraLabelledAdapter patient(options, labels_);
  std::size_t finished = 0;
  for (int i = 0; i < 70; ++i)
    finished += patient.adapt(*scanAt(0.01 * i), roundedPose({}), rules_)->size();
  EXPECT_EQ(finished, 6U);
  EXPECT_EQ(patient.cameraStatistics()->scans.without_image, 6U);
  EXPECT_EQ(patient.flush().size(), 64U);
}

// Inside a map.

CSemanticContinuousMap cameraMap() {
  Options options;
  options.resolution = 0.2;
  CSemanticContinuousMap map(options, sampleLabels());
  map.labelOptions = cameraOptions();
  return map;
}

TEST(CameraLabelledMap, ScansThatWaitAreInWhatIsSavedButNotYetInTheMap) {
  CSemanticContinuousMap map = cameraMap();
  EXPECT_TRUE(map.insertObservation(*labelImage(-0.05)));
  EXPECT_EQ(map.lastInsertion().outcome, LastInsertion::Outcome::Kept);
  EXPECT_TRUE(map.insertObservation(*scanAt(0)));
  EXPECT_EQ(map.lastInsertion().outcome, LastInsertion::Outcome::Kept);
  EXPECT_TRUE(map.isEmpty());
  EXPECT_EQ(map.document().scans.size(), 1U);
  EXPECT_GT(map.document().map.knownVoxelCount(), 0U);
  EXPECT_TRUE(map.isEmpty());
  map.flush();
  EXPECT_EQ(map.map().at({5, 1, 0}).mostLikelyClass(), kRoad);
  EXPECT_EQ(map.map().at({5, -1, 0}).mostLikelyClass(), kWall);
  EXPECT_EQ(map.scans().size(), 1U);
}

TEST(CameraLabelledMap, CopiesCarryWhatWaits) {
  CSemanticContinuousMap map = cameraMap();
  map.insertObservation(*labelImage(0, kWallId, kWallId));
  map.insertObservation(*scanAt(0.04));
  ASSERT_TRUE(map.isEmpty());

  CSemanticContinuousMap copy(map);
  CSemanticContinuousMap assigned;
  assigned = map;
  CSemanticContinuousMap streamed;
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << map;
  stream.Seek(0);
  archive >> streamed;

  for (CSemanticContinuousMap* each : {&map, &copy, &assigned, &streamed}) {
    each->insertObservation(*labelImage(0.05));
    ASSERT_EQ(each->scans().size(), 1U);
    EXPECT_EQ(each->map().at({5, 1, 0}).mostLikelyClass(), kRoad);
    EXPECT_EQ(each->map().at({5, -1, 0}).mostLikelyClass(), kWall);
    ASSERT_TRUE(each->cameraStatistics());
    EXPECT_EQ(each->cameraStatistics()->cameras[0].images.read, 2U);
    EXPECT_EQ(each->cameraStatistics()->cameras[0].images.used, 1U);
  }
}

TEST(CameraLabelledMap, AnyLabelOutvotesWhatNoCameraSaw) {
  LabelOptions options = cameraOptions();
  options.outside_view = OutsideView::Unlabelled;
  CSemanticContinuousMap map = cameraMap();
  map.labelOptions = options;
  const std::vector<Eigen::Vector3f> point{{5, 1, 0}};
  for (int i = 0; i < 20; ++i) map.insertObservation(*scanAt(i, point));
  map.flush();
  EXPECT_EQ(map.map().at({5, 1, 0}).mostLikelyClass(), kUnlabelled);
  map.insertObservation(*labelImage(30));
  map.insertObservation(*scanAt(30, point));
  EXPECT_EQ(map.map().at({5, 1, 0}).mostLikelyClass(), kRoad);
}

TEST(CameraLabelledMap, ADamagedImageIsReportedAndTheScanBeforeItIsNotLost) {
  CSemanticContinuousMap map = cameraMap();
  map.warn_of_damaged = false;
  map.insertObservation(*labelImage(0));
  map.insertObservation(*scanAt(0.02));
  auto image = labelImage(0.02);
  image->cameraParams = mrpt::img::TCamera();
  EXPECT_FALSE(map.insertObservation(*image));
  EXPECT_EQ(map.lastInsertion().outcome, LastInsertion::Outcome::Damaged);
  EXPECT_EQ(map.statistics().damaged.at("CObservationImage"), 1U);
  map.flush();
  EXPECT_EQ(map.scans().size(), 1U);
}

}  // namespace
}  // namespace csom
