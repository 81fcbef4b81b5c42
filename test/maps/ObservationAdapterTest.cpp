// SPDX-License-Identifier: BSD-3-Clause
// Every kind of observation, with its labels, becomes the right points.
#include <csom/maps/ObservationAdapter.h>
#include <csom/maps/PoseRounding.h>
#include <csom/maps/VelodynePackets.h>
#include <gmock/gmock.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CRawlog.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "SampleObservations.h"

namespace csom {
namespace {

using mrpt::obs::CObservation3DRangeScan;
using mrpt::poses::CPose3D;
using sample::laserScan;
using sample::pointCloud;
using sample::rangeCamera;
using sample::sampleLabels;

class ObservationAdapter : public testing::Test {
 protected:
  LabelRules rules(PointLabels source, const std::string& unlabelled = "drop",
                   const std::string& scan_2d = "") const {
    return LabelRules(labels_, source, unlabelled, scan_2d);
  }
  AdaptedScan adapt(const mrpt::obs::CObservation& observation, const LabelRules& with,
                    const CPose3D& robot = {}) {
    auto scans = adapter_.adapt(observation, roundedPose(robot), with);
    if (!scans || scans->size() != 1) throw std::logic_error("not one scan");
    return scans->front();
  }

  LabelSet labels_ = sampleLabels();
  SelfLabelledAdapter adapter_;
};

void expectNear(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float tolerance = 1e-5f) {
  EXPECT_LT((a - b).norm(), tolerance) << a.transpose() << " against " << b.transpose();
}

mrpt::obs::CObservationVelodyneScan::Ptr velodyneCloud() {
  auto scan = mrpt::obs::CObservationVelodyneScan::Create();
  scan->point_cloud.x = {1, 2, 3, 4};
  scan->point_cloud.y = {0, 0, 0, 0};
  scan->point_cloud.z = {0, 0, 0, 0};
  scan->point_cloud.intensity = {40, 50, 0, 77};
  return scan;
}

mrpt::obs::CObservation::Ptr firstOf(const std::string& rawlog) {
  const std::string file = "/usr/share/mrpt/datasets/" + rawlog;
  mrpt::obs::CRawlog log;
  if (!log.loadFromRawLogFile(file) || log.size() == 0)
    throw std::runtime_error(file + " is missing: install the package mrpt-common");
  return log.getAsObservation(0);
}

TEST_F(ObservationAdapter, OtherKindsAreNotTaken) {
  EXPECT_FALSE(adapter_.adapt(mrpt::obs::CObservationOdometry(), Eigen::Isometry3d::Identity(),
                              rules(PointLabels::None)));
}

TEST_F(ObservationAdapter, ScansTellWhereTheyComeFrom) {
  const AdaptedScan scan = adapt(*pointCloud({{1, 0, 0}}, {40}), rules(PointLabels::ByIntensity));
  EXPECT_EQ(scan.sensor_label, "cloud");
  EXPECT_EQ(scan.observation_class, "CObservationPointCloud");
  EXPECT_DOUBLE_EQ(scan.timestamp, 1500000000.25);
}

TEST_F(ObservationAdapter, PointsAreRelativeToTheSensorInTheAxesOfTheMap) {
  auto observation = pointCloud({{2, 0, 0}}, {40});
  observation->sensorPose = CPose3D(0.5, 0, 1, 0, 0, 0);
  const CPose3D robot(100000, 200000, 0, M_PI / 2, 0, 0);
  const AdaptedScan scan = adapt(*observation, rules(PointLabels::ByIntensity), robot);
  EXPECT_LT((scan.scan.origin - Eigen::Vector3d(100000, 200000.5, 1)).norm(), 1e-5);
  expectNear(scan.scan.points.at(0), {0, 2, 0});
}

TEST_F(ObservationAdapter, LabelsOfPointsAreCountedByFate) {
  const auto observation =
      pointCloud({{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}, {40, 50, 0, 77});
  const AdaptedScan scan = adapt(*observation, rules(PointLabels::ByIntensity));
  EXPECT_THAT(scan.scan.labels, testing::ElementsAre(1, 2));
  EXPECT_EQ(scan.labels.labelled, 2u);
  EXPECT_EQ(scan.labels.ignored, 1u);
  EXPECT_EQ(scan.labels.unknown, 1u);
  EXPECT_EQ(scan.labels.dropped(), 2u);
}

TEST_F(ObservationAdapter, PointsWithoutLabelFollowTheRule) {
  const auto observation = pointCloud({{1, 0, 0}, {2, 0, 0}}, {40, 50});
  const AdaptedScan kept = adapt(*observation, rules(PointLabels::None, "wall"));
  EXPECT_THAT(kept.scan.labels, testing::ElementsAre(2, 2));
  EXPECT_EQ(kept.labels.unlabelled, 2u);
  const AdaptedScan dropped = adapt(*observation, rules(PointLabels::None));
  EXPECT_TRUE(dropped.scan.points.empty());
  EXPECT_EQ(dropped.labels.missing, 2u);
}

TEST_F(ObservationAdapter, ColouredCloud) {
  auto cloud = mrpt::maps::CColouredPointsMap::Create();
  cloud->insertPointRGB(1, 0, 0, 128 / 255.f, 64 / 255.f, 128 / 255.f);
  cloud->insertPointRGB(2, 0, 0, 0, 200 / 255.f, 0);
  cloud->insertPointRGB(3, 0, 0, 0, 0, 0);
  mrpt::obs::CObservationPointCloud observation;
  observation.pointcloud = cloud;
  const AdaptedScan scan = adapt(observation, rules(PointLabels::ByColor));
  EXPECT_THAT(scan.scan.labels, testing::ElementsAre(1, 2));
  EXPECT_EQ(scan.labels.unknown, 1u);
}

TEST_F(ObservationAdapter, CloudOfUnequalNumbersIsDamaged) {
  auto cloud = mrpt::maps::CPointsMapXYZI::Create();
  cloud->resize(2);
  const auto& intensities = cloud->getPointsBufferRef_intensity();
  const_cast<mrpt::aligned_std_vector<float>&>(intensities).resize(3);
  mrpt::obs::CObservationPointCloud observation;
  observation.pointcloud = cloud;
  EXPECT_THROW(adapt(observation, rules(PointLabels::ByIntensity)), std::runtime_error);
}

TEST_F(ObservationAdapter, CloudWithoutCloudIsDamaged) {
  EXPECT_THROW(adapt(mrpt::obs::CObservationPointCloud(), rules(PointLabels::None)),
               std::runtime_error);
}

TEST_F(ObservationAdapter, ExternallyStoredCloudIsLoaded) {
  const std::string file = testing::TempDir() + "csom_external_cloud.bin";
  std::ofstream(file, std::ios::binary)
      .write("\0\0\x80\x3f\0\0\0\0\0\0\0\0\0\0\x20\x42", 16);  // 1 0 0, intensity 40
  mrpt::obs::CObservationPointCloud observation;
  observation.setAsExternalStorage(
      file, mrpt::obs::CObservationPointCloud::ExternalStorageFormat::KittiBinFile);
  const AdaptedScan scan = adapt(observation, rules(PointLabels::ByIntensity));
  EXPECT_THAT(scan.scan.labels, testing::ElementsAre(1));
  expectNear(scan.scan.points.at(0), {1, 0, 0});
}

TEST_F(ObservationAdapter, VelodyneCloudWithoutPacketsIsUsedAsItIs) {
  const AdaptedScan scan = adapt(*velodyneCloud(), rules(PointLabels::ByIntensity));
  EXPECT_THAT(scan.scan.labels, testing::ElementsAre(1, 2));
  expectNear(scan.scan.points.at(1), {2, 0, 0});
  EXPECT_EQ(scan.labels.ignored, 1u);
  EXPECT_EQ(scan.labels.unknown, 1u);
}

TEST_F(ObservationAdapter, VelodynePacketsAreDecoded) {
  const auto observation = firstOf("test_velodyne_VLP16.rawlog");
  const auto& recorded = dynamic_cast<const mrpt::obs::CObservationVelodyneScan&>(*observation);
  ASSERT_TRUE(recorded.point_cloud.x.empty());
  const AdaptedScan scan = adapt(*observation, rules(PointLabels::None, "wall"));
  EXPECT_TRUE(recorded.point_cloud.x.empty()) << "the observation was modified";
  const std::vector<VelodyneBeam> beams = decodePackets(recorded);
  EXPECT_EQ(scan.scan.points.size() + scan.no_returns, beams.size());
  std::size_t i = 0;
  for (const VelodyneBeam& beam : beams)
    if (beam.returned) expectNear(scan.scan.points.at(i++), beam.point);
}

TEST_F(ObservationAdapter, DamagedVelodyneScansAreErrors) {
  auto uneven = velodyneCloud();
  uneven->point_cloud.intensity.pop_back();
  EXPECT_THROW(adapt(*uneven, rules(PointLabels::None)), std::exception);

  auto uncalibrated = dynamic_cast<const mrpt::obs::CObservationVelodyneScan&>(
      *firstOf("test_velodyne_VLP16.rawlog"));
  uncalibrated.calibration = {};
  EXPECT_THROW(adapt(uncalibrated, rules(PointLabels::None)), std::exception);
}

TEST_F(ObservationAdapter, RangeImageIsUnprojected) {
  auto observation = rangeCamera();
  observation->rangeImage(0, 0) = 0;  // no return
  const AdaptedScan scan = adapt(*observation, rules(PointLabels::None, "wall"));
  ASSERT_EQ(scan.scan.points.size(), 47u);
  // Column 1 of row 0: y = (3.5 - 1)/8 * 2 m, z = 2.5/8 * 2 m.
  expectNear(scan.scan.points[0], {2.0f, 0.625f, 0.625f});
}

template <unsigned int Bytes>
std::shared_ptr<mrpt::obs::TPixelLabelInfo<Bytes>> pixelLabels(int rows, int columns) {
  auto info = std::make_shared<mrpt::obs::TPixelLabelInfo<Bytes>>();
  info->setSize(rows, columns);
  return info;
}

TEST_F(ObservationAdapter, LabelsOfPixelsGoWithTheirPoints) {
  auto observation = rangeCamera();
  observation->rangeImage(0, 0) = 0;  // so that points and pixels are not numbered alike
  auto info = pixelLabels<8>(6, 8);
  info->setLabel(0, 1, 40);  // row, column, bit: beyond the 8 bits of the virtual interface
  info->setLabel(0, 2, 50);
  info->setLabel(0, 3, 0);   // ignored
  info->setLabel(0, 4, 41);  // unknown
  info->setLabel(0, 5, 40);  // two labels
  info->setLabel(0, 5, 50);
  observation->pixelLabels = info;
  const AdaptedScan scan = adapt(*observation, rules(PointLabels::None));
  EXPECT_THAT(scan.scan.labels, testing::ElementsAre(1, 2));
  expectNear(scan.scan.points.at(0), {2.0f, 0.625f, 0.625f});
  EXPECT_EQ(scan.labels.ignored, 1u);
  EXPECT_EQ(scan.labels.unknown, 1u);
  EXPECT_EQ(scan.labels.ambiguous, 1u);
  EXPECT_EQ(scan.labels.missing, 42u);
}

TEST_F(ObservationAdapter, NamedBitsOfAllWidths) {
  const auto check = [&](auto info) {
    auto observation = rangeCamera();
    info->setLabel(2, 3, 5);
    info->setLabelName(5, "wall");
    info->setLabel(2, 4, 6);
    info->setLabelName(6, "lawn");
    observation->pixelLabels = info;
    const AdaptedScan scan = adapt(*observation, rules(PointLabels::None));
    EXPECT_THAT(scan.scan.labels, testing::ElementsAre(2));
    EXPECT_EQ(scan.labels.unknown, 1u);
  };
  check(pixelLabels<1>(6, 8));
  check(pixelLabels<2>(6, 8));
  check(pixelLabels<4>(6, 8));
  check(pixelLabels<8>(6, 8));
}

TEST_F(ObservationAdapter, RangeCameraWithPointsOnly) {
  CObservation3DRangeScan observation;
  observation.hasPoints3D = true;
  observation.points3D_x = {1, 2};
  observation.points3D_y = {0, 0};
  observation.points3D_z = {0, 0};
  EXPECT_EQ(adapt(observation, rules(PointLabels::None, "wall")).scan.points.size(), 2u);
}

TEST_F(ObservationAdapter, DamagedRangeCamerasAreErrors) {
  auto wrong_labels = rangeCamera();
  wrong_labels->pixelLabels = pixelLabels<1>(5, 8);
  EXPECT_THROW(adapt(*wrong_labels, rules(PointLabels::None)), std::runtime_error);

  auto wrong_size = rangeCamera();
  wrong_size->cameraParams.ncols = 640;
  EXPECT_THROW(adapt(*wrong_size, rules(PointLabels::None)), std::runtime_error);

  auto empty = CObservation3DRangeScan();
  empty.hasRangeImage = true;
  EXPECT_THROW(adapt(empty, rules(PointLabels::None)), std::runtime_error);
}

TEST_F(ObservationAdapter, LaserScanHasOneClassAndOnlyValidRays) {
  auto observation = laserScan(5);
  observation->setScanRangeValidity(1, false);
  observation->setScanRange(2, 20.0f);  // maxRange: nothing was hit
  const AdaptedScan scan = adapt(*observation, rules(PointLabels::ByIntensity, "drop", "wall"));
  EXPECT_THAT(scan.scan.labels, testing::ElementsAre(2, 2, 2));
  expectNear(scan.scan.points[0], {0, -5, 0});
  expectNear(scan.scan.points[2], {0, 5, 0});

  observation->rightToLeft = false;
  expectNear(adapt(*observation, rules(PointLabels::None, "wall")).scan.points[0], {0, 5, 0});
  EXPECT_EQ(adapt(*observation, rules(PointLabels::None)).labels.missing, 3u);
}

TEST_F(ObservationAdapter, EmptyObservationsHaveNoPoints) {
  EXPECT_TRUE(adapt(*laserScan(0), rules(PointLabels::None, "wall")).scan.points.empty());
  EXPECT_TRUE(adapt(*pointCloud({}, {}), rules(PointLabels::None, "wall")).scan.points.empty());
  EXPECT_TRUE(adapt(mrpt::obs::CObservationVelodyneScan(), rules(PointLabels::None, "wall"))
                  .scan.points.empty());
}

/// Largest distance from a point of `scan` to the nearest of `others`, of the nearest 95 %.
double typicalDistance(const Scan& scan, const Scan& others) {
  std::vector<double> distances;
  for (std::size_t i = 0; i < scan.points.size(); i += 50) {
    float best = std::numeric_limits<float>::max();
    for (const Eigen::Vector3f& other : others.points)
      best = std::min(best, (other - scan.points[i]).squaredNorm());
    distances.push_back(std::sqrt(static_cast<double>(best)));
  }
  std::sort(distances.begin(), distances.end());
  return distances[distances.size() * 95 / 100];
}

TEST_F(ObservationAdapter, RotatingScanEqualsTheVelodyneScanItWasMadeOf) {
  const AdaptedScan rotating =
      adapt(*firstOf("rot_scan_velodyne.rawlog"), rules(PointLabels::None, "wall"));
  const AdaptedScan velodyne =
      adapt(*firstOf("test_velodyne_VLP16.rawlog"), rules(PointLabels::None, "wall"));
  // MRPT reads the first one of two firings.
  EXPECT_NEAR(static_cast<double>(rotating.scan.points.size()),
              0.5 * static_cast<double>(velodyne.scan.points.size()), 200);
  EXPECT_LT(typicalDistance(rotating.scan, velodyne.scan), 0.1);
}

TEST_F(ObservationAdapter, RotatingScanWithLabels) {
  mrpt::obs::CObservationRotatingScan observation;
  observation.rowCount = 1;
  observation.columnCount = 3;
  observation.rangeResolution = 0.01;
  observation.startAzimuth = 0;
  observation.azimuthSpan = M_PI;
  observation.rangeImage.setZero(1, 3);
  observation.rangeImage(0, 0) = 100;
  observation.rangeImage(0, 2) = 200;
  observation.intensityImage.setZero(1, 3);
  observation.intensityImage(0, 0) = 40;
  observation.intensityImage(0, 2) = 50;
  const AdaptedScan scan = adapt(observation, rules(PointLabels::ByIntensity));
  EXPECT_THAT(scan.scan.labels, testing::ElementsAre(1, 2));
  expectNear(scan.scan.points.at(0), {1, 0, 0});
  expectNear(scan.scan.points.at(1), {-2, 0, 0});

  observation.intensityImage.setZero(1, 2);
  EXPECT_THROW(adapt(observation, rules(PointLabels::ByIntensity)), std::runtime_error);
}

TEST_F(ObservationAdapter, RotatingScanOfUnknownGeometryIsAnError) {
  mrpt::obs::CObservationRotatingScan observation;
  observation.lidarModel = "OS1";
  observation.rowCount = 4;
  observation.columnCount = 4;
  observation.rangeResolution = 0.01;
  observation.rangeImage.setZero(4, 4);
  try {
    adapt(observation, rules(PointLabels::None));
    FAIL() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("'OS1' with 4 rows"));
  }
  observation.columnCount = 5;
  EXPECT_THROW(adapt(observation, rules(PointLabels::None)), std::runtime_error);
}

TEST_F(ObservationAdapter, NonFinitePointsReachTheMapToBeCounted) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const AdaptedScan scan =
      adapt(*pointCloud({{nan, 0, 0}, {1, 0, 0}}, {40, 40}), rules(PointLabels::ByIntensity));
  EXPECT_EQ(scan.scan.points.size(), 2u);
  EXPECT_TRUE(std::isnan(scan.scan.points[0].x()));
}

}  // namespace
}  // namespace csom
