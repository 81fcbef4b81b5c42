// SPDX-License-Identifier: BSD-3-Clause
// Which points of an observation lie beside each other, and what beams without a return say.
#include <csom/maps/CSemanticContinuousMap.h>
#include <csom/maps/ObservationAdapter.h>
#include <csom/maps/PoseRounding.h>
#include <csom/maps/VelodynePackets.h>
#include <gmock/gmock.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cmath>

#include "SampleObservations.h"

namespace csom {
namespace {

using mrpt::obs::CObservationRotatingScan;
using mrpt::obs::CObservationVelodyneScan;
using sample::pointCloud;
using sample::rangeCamera;
using sample::sampleLabels;

CObservationVelodyneScan::Ptr recordedScan() {
  mrpt::obs::CRawlog log;
  const std::string file = "/usr/share/mrpt/datasets/test_velodyne_VLP16.rawlog";
  if (!log.loadFromRawLogFile(file)) throw std::runtime_error(file + " is missing");
  return std::dynamic_pointer_cast<CObservationVelodyneScan>(log.getAsObservation(0));
}

/// What a spinning sensor sees from the middle of a round room, row after row.
std::vector<Eigen::Vector3f> spinningCloud(int rows = 16, int columns = 900) {
  std::vector<Eigen::Vector3f> points;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double azimuth = 2 * M_PI * (column + 0.3) / columns;
      const double elevation = 0.035 * (row - 7.5);
      points.push_back(
          4 *
          Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), std::tan(elevation)).cast<float>());
    }
  return points;
}

class ScanImages : public testing::Test {
 protected:
  AdaptedScan adapt(const mrpt::obs::CObservation& observation, const BeamRequest& request,
                    PointLabels labels = PointLabels::None) {
    const std::string unlabelled = labels == PointLabels::None ? "wall" : "drop";
    const LabelRules rules(labels_, labels, unlabelled, "wall");
    SelfLabelledAdapter adapter(request);
    auto scans = adapter.adapt(observation, roundedPose({1, 2, 3, 0.4, 0, 0}), rules);
    if (!scans || scans->size() != 1) throw std::logic_error("not one scan");
    return scans->front();
  }
  AdaptedScan adapt(const mrpt::obs::CObservation& observation) {
    return adapt(observation, {true, 0});
  }

  LabelSet labels_ = sampleLabels();
};

TEST_F(ScanImages, PacketsTellRowsAndAzimuths) {
  const auto observation = recordedScan();
  const AdaptedScan scan = adapt(*observation, {false, 0});
  EXPECT_EQ(scan.image_origin, ImageOrigin::Sensor);
  const RangeImage& image = scan.scan.image;
  EXPECT_EQ(image.columns_of_turn, 36000);
  EXPECT_NEAR(image.column_step, 20, 1) << "600 turns a minute, two firings a block";
  ASSERT_EQ(image.pixels.size(), scan.scan.points.size());
  const auto rows = rowsOfLasers(observation->calibration);
  std::size_t i = 0;
  for (const VelodyneBeam& beam : decodePackets(*observation)) {
    if (!beam.returned) continue;
    EXPECT_EQ(image.pixels[i].row, rows[beam.laser]);
    EXPECT_EQ(image.pixels[i].column, beam.azimuth);
    ++i;
  }
}

TEST_F(ScanImages, PointsThatAreDroppedLeaveTheirPixelsEmpty) {
  const auto observation = recordedScan();
  const AdaptedScan all = adapt(*observation);
  // Intensities as raw ids: 40 and 50 have a class.
  const AdaptedScan some = adapt(*observation, {true, 0}, PointLabels::ByIntensity);
  ASSERT_LT(some.scan.points.size(), all.scan.points.size());
  ASSERT_EQ(some.scan.image.pixels.size(), some.scan.points.size());
  std::size_t i = 0;
  for (std::size_t kept = 0; kept < some.scan.points.size(); ++kept, ++i) {
    while (i < all.scan.points.size() && all.scan.points[i] != some.scan.points[kept]) ++i;
    ASSERT_LT(i, all.scan.points.size());
    EXPECT_EQ(some.scan.image.pixels[kept], all.scan.image.pixels[i]);
  }
  EXPECT_EQ(some.scan.image.column_step, all.scan.image.column_step);
}

TEST_F(ScanImages, StoredCloudsOfAVelodyneMayTellTheirLasers) {
  auto scan = recordedScan();
  const AdaptedScan packets = adapt(*scan);
  CObservationVelodyneScan::TGeneratePointCloudParameters parameters;
  parameters.minDistance = 0;
  scan->generatePointCloud(parameters);
  scan->scan_packets.clear();
  ASSERT_EQ(scan->point_cloud.laser_id.size(), scan->point_cloud.size());
  const AdaptedScan lasers = adapt(*scan);
  EXPECT_EQ(lasers.image_origin, ImageOrigin::Sensor);
  ASSERT_EQ(lasers.scan.image.pixels.size(), scan->point_cloud.size());
  const auto rows = rowsOfLasers(scan->calibration);
  for (std::size_t i = 0; i < scan->point_cloud.size(); ++i) {
    EXPECT_EQ(lasers.scan.image.pixels[i].row,
              rows[static_cast<std::size_t>(scan->point_cloud.laser_id[i])]);
    const double azimuth =
        std::atan2(scan->point_cloud.y[i], scan->point_cloud.x[i]) * 18000 / M_PI;
    EXPECT_LT(std::abs(std::remainder(azimuth - lasers.scan.image.pixels[i].column - 0.5, 36000.0)),
              0.6);
  }

  scan->point_cloud.azimuth.assign(scan->point_cloud.size(), -10);
  const AdaptedScan azimuths = adapt(*scan);
  EXPECT_EQ(azimuths.scan.image.pixels[7].column, 35000);
  scan->point_cloud.azimuth[7] = NAN;
  EXPECT_THROW(adapt(*scan), std::runtime_error);

  scan->point_cloud.azimuth.clear();
  scan->point_cloud.laser_id[3] = 16;  // no such laser: the rows are searched for
  EXPECT_EQ(adapt(*scan).image_origin, ImageOrigin::Found);
  EXPECT_TRUE(packets.scan.points.size() > scan->point_cloud.size());
}

TEST_F(ScanImages, CloudsAreSearchedForRowsIfTheyAreWanted) {
  const std::vector<Eigen::Vector3f> points = spinningCloud();
  const auto cloud = pointCloud(points, std::vector<float>(points.size(), 50));
  EXPECT_EQ(adapt(*cloud, {false, 0}).image_origin, ImageOrigin::None);
  EXPECT_TRUE(adapt(*cloud, {false, 0}).scan.image.empty());
  const AdaptedScan found = adapt(*cloud);
  EXPECT_EQ(found.image_origin, ImageOrigin::Found);
  ASSERT_EQ(found.scan.image.pixels.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_EQ(found.scan.image.pixels[i].row, i / 900);
  EXPECT_EQ(found.scan.image.column_step, 40);

  // Beams without a return hold the places of a grid, and are no points.
  std::vector<Eigen::Vector3f> grid;
  for (int i = 0; i < 20 * 50; ++i)
    grid.push_back(i % 13 == 0 ? Eigen::Vector3f(0, 0, 0)
                               : Eigen::Vector3f(5, 0.05F * static_cast<float>(i % 50 - 25),
                                                 0.05F * static_cast<float>(i / 50)));
  const AdaptedScan camera = adapt(*pointCloud(grid, std::vector<float>(grid.size(), 50)));
  EXPECT_EQ(camera.image_origin, ImageOrigin::Found);
  ASSERT_EQ(camera.scan.image.pixels.size(), camera.scan.points.size());
  for (std::size_t i = 0, kept = 0; i < grid.size(); ++i) {
    if (i % 13 == 0) continue;
    EXPECT_EQ(camera.scan.image.pixels[kept].row, i / 50);
    EXPECT_EQ(camera.scan.image.pixels[kept++].column, static_cast<std::int32_t>(i % 50));
  }

  const AdaptedScan room = adapt(*sample::roomCloud());
  EXPECT_EQ(room.image_origin, ImageOrigin::None);
  EXPECT_TRUE(room.scan.image.empty());
}

CObservationRotatingScan rotatingScan(int columns, double span) {
  CObservationRotatingScan scan;
  scan.lidarModel = "VLP-16";
  scan.rowCount = 16;
  scan.columnCount = static_cast<std::uint16_t>(columns);
  scan.rangeResolution = 0.01;
  scan.startAzimuth = 0;
  scan.azimuthSpan = span;
  scan.rangeImage.setZero(16, columns);
  scan.rangeImage.fill(300);
  return scan;
}

TEST_F(ScanImages, RotatingScansAreImages) {
  auto scan = rotatingScan(360, 359 * M_PI / 180);
  scan.rangeImage(2, 5) = 0;
  const AdaptedScan turn = adapt(scan);
  EXPECT_EQ(turn.image_origin, ImageOrigin::Sensor);
  EXPECT_EQ(turn.scan.image.columns_of_turn, 360);
  EXPECT_EQ(turn.scan.image.column_step, 1);
  ASSERT_EQ(turn.scan.image.pixels.size(), 16 * 360 - 1);
  // Column by column; rows are those of the lasers, which do not fire in their order.
  EXPECT_EQ(turn.scan.image.pixels[1], (RangeImage::Pixel{8, 0}));
  EXPECT_EQ(turn.scan.image.pixels[16 * 5 + 2], (RangeImage::Pixel{9, 5})) << "behind the lost one";
  EXPECT_EQ(adapt(rotatingScan(90, 89 * M_PI / 180)).scan.image.columns_of_turn, 0) << "a quarter";

  const AdaptedScan row = adapt(*sample::rotatingScan());
  EXPECT_EQ(row.image_origin, ImageOrigin::None) << "nothing lies above or below";
  EXPECT_TRUE(row.scan.image.empty());
  EXPECT_TRUE(adapt(*sample::laserScan()).scan.image.empty());
}

TEST_F(ScanImages, RangeCamerasAreImages) {
  auto observation = rangeCamera();
  observation->rangeImage(0, 0) = 0;
  const AdaptedScan scan = adapt(*observation);
  EXPECT_EQ(scan.image_origin, ImageOrigin::Sensor);
  EXPECT_EQ(scan.scan.image.columns_of_turn, 0);
  ASSERT_EQ(scan.scan.image.pixels.size(), 47U);
  EXPECT_EQ(scan.scan.image.pixels[0], (RangeImage::Pixel{0, 1}));
  EXPECT_EQ(scan.scan.image.pixels[7], (RangeImage::Pixel{1, 0}));

  mrpt::obs::CObservation3DRangeScan points;
  points.hasPoints3D = true;
  points.points3D_x = {1, 2};
  points.points3D_y = points.points3D_z = {0, 0};
  EXPECT_EQ(adapt(points).image_origin, ImageOrigin::None);
}

TEST_F(ScanImages, BeamsWithoutAReturnAreFreeIfThatIsAskedFor) {
  const auto observation = recordedScan();
  observation->maxRange = 60;
  const AdaptedScan as_ever = adapt(*observation);
  for (const double range : {30.0, 80.0}) {
    const AdaptedScan scan = adapt(*observation, {true, range});
    ASSERT_EQ(scan.scan.points.size(), as_ever.scan.points.size() + scan.no_returns);
    ASSERT_EQ(scan.scan.image.pixels.size(), scan.scan.points.size());
    ASSERT_EQ(scan.scan.labels.size(), scan.scan.points.size());
    for (std::size_t i = as_ever.scan.points.size(); i < scan.scan.points.size(); ++i) {
      EXPECT_EQ(scan.scan.labels[i], kFreeClass);
      const float at = scan.scan.points[i].norm();
      EXPECT_LT(at, std::min(range, 60.0)) << "as far as the sensor sees";
      EXPECT_GT(at, std::min(range, 60.0) - 0.01);
    }
  }
  // What is nearer than the sensor measures is no point, but nothing is free behind it.
  const AdaptedScan whole = adapt(*observation, {true, 30});
  observation->minRange = 5;
  const AdaptedScan blocked = adapt(*observation, {true, 30});
  EXPECT_GT(blocked.no_returns, whole.no_returns + 1000);
  EXPECT_EQ(std::count(blocked.scan.labels.begin(), blocked.scan.labels.end(), kFreeClass),
            std::count(whole.scan.labels.begin(), whole.scan.labels.end(), kFreeClass));

  auto rotating = rotatingScan(360, 359 * M_PI / 180);
  rotating.rangeImage(2, 5) = 0;
  const AdaptedScan scan = adapt(rotating, {true, 20});
  ASSERT_EQ(scan.scan.points.size(), 16U * 360);
  EXPECT_EQ(scan.scan.image.pixels.back(), (RangeImage::Pixel{1, 5}));
  EXPECT_EQ(adapt(*sample::laserScan(3), {true, 20}).scan.points.size(), 3U);
}

class ScanImagesOfMap : public testing::Test {
 protected:
  static CSemanticContinuousMap makeMap(Method method, bool no_return = false) {
    Options options;
    options.method = method;
    options.free_space.mode = FreeSpace::Projective;
    options.free_space.no_return = no_return;
    options.scan.max_range = 40;
    CSemanticContinuousMap map(options, sampleLabels());
    map.insertionOptions.point_labels = PointLabels::None;
    map.insertionOptions.unlabelled_class = "wall";
    return map;
  }
};

TEST_F(ScanImagesOfMap, AMapCountsWhereTheyCameFrom) {
  CSemanticContinuousMap map = makeMap(Method::SurfaceCsom);
  const std::vector<Eigen::Vector3f> points = spinningCloud();
  const auto cloud = pointCloud(points, std::vector<float>(points.size(), 50));
  ASSERT_TRUE(map.insertObservation(*recordedScan()));
  ASSERT_TRUE(map.insertObservation(*cloud));
  ASSERT_TRUE(map.insertObservation(*sample::roomCloud()));
  ASSERT_TRUE(map.insertObservation(*sample::roomCloud()));
  EXPECT_EQ(map.statistics().images.of_sensor, 1U);
  EXPECT_EQ(map.statistics().images.found, 1U);
  EXPECT_EQ(map.statistics().images.none, 2U);

  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << map;
  stream.Seek(0);
  CSemanticContinuousMap read;
  archive >> read;
  EXPECT_EQ(read.statistics().images.found, 1U);
  EXPECT_EQ(read.statistics().images.none, 2U);

  CSemanticContinuousMap other = makeMap(Method::SeeCsom);
  ASSERT_TRUE(other.insertObservation(*cloud));
  EXPECT_EQ(other.statistics().images.none, 0U) << "the method does not look at them";
}

TEST_F(ScanImagesOfMap, FreeBeamsMakeTheirWayFree) {
  const auto scan = recordedScan();
  CSemanticContinuousMap with = makeMap(Method::SurfaceCsom, true);
  CSemanticContinuousMap without = makeMap(Method::SurfaceCsom);
  ASSERT_TRUE(with.insertObservation(*scan));
  ASSERT_TRUE(without.insertObservation(*scan));
  EXPECT_GT(with.scans().front().report.free_voxels,
            without.scans().front().report.free_voxels * 11 / 10);
}

}  // namespace
}  // namespace csom
