// SPDX-License-Identifier: BSD-3-Clause
// Matching against other maps prefers the true pose.
#include <csom/maps/CSemanticContinuousMap.h>
#include <gtest/gtest.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/slam/CICP.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <thread>
#include <vector>

#include "SampleObservations.h"

namespace csom {
namespace {

using mrpt::poses::CPose3D;
using sample::roomCloud;
using sample::roomMap;
using sample::roomPoints;

mrpt::maps::CSimplePointsMap roomPointsMap() {
  mrpt::maps::CSimplePointsMap points;
  for (const Eigen::Vector3f& p : roomPoints()) points.insertPoint(p.x(), p.y(), p.z());
  return points;
}

float ratioOf3dMatches(const CSemanticContinuousMap& map,
                       const mrpt::maps::CSimplePointsMap& other) {
  mrpt::maps::TMatchingParams params;
  params.maxDistForCorrespondence = 0.3f;
  mrpt::tfest::TMatchingPairList pairs;
  mrpt::maps::TMatchingExtraResults results;
  map.determineMatching3D(&other, CPose3D(), pairs, params, results);
  return results.correspondencesRatio;
}

TEST(Matching, IsTheSameFromManyThreads) {
  const CSemanticContinuousMap map = roomMap();
  const auto observation = roomCloud();
  const double expected = map.computeObservationLikelihood(*observation, CPose3D());
  std::vector<double> values(4);
  std::vector<std::size_t> points(values.size());
  std::vector<float> ratios(values.size());
  std::vector<mrpt::math::TBoundingBoxf> boxes(values.size());
  const mrpt::maps::CSimplePointsMap other = roomPointsMap();
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < values.size(); ++i) {
    threads.emplace_back([&, i] {
      values[i] = map.computeObservationLikelihood(*observation, CPose3D());
      points[i] = map.getAsSimplePointsMap()->size();
      ratios[i] = ratioOf3dMatches(map, other);
      boxes[i] = map.getAsSimplePointsMap()->boundingBox();
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const double value : values) EXPECT_EQ(value, expected);
  for (const std::size_t count : points) EXPECT_EQ(count, map.getAsSimplePointsMap()->size());
  for (const float ratio : ratios) EXPECT_GT(ratio, 0.99f);
  const auto box = map.getAsSimplePointsMap()->boundingBox();
  for (const auto& each : boxes) {
    EXPECT_EQ(each.min, box.min);
    EXPECT_EQ(each.max, box.max);
  }
}

TEST(Matching, FindsItsOwnPoints) {
  const CSemanticContinuousMap map = roomMap();
  const mrpt::maps::CSimplePointsMap points = roomPointsMap();
  mrpt::maps::TMatchingParams params;
  params.maxDistForCorrespondence = 0.3f;
  mrpt::tfest::TMatchingPairList pairs;
  mrpt::maps::TMatchingExtraResults results;
  map.determineMatching3D(&points, CPose3D(), pairs, params, results);
  EXPECT_GT(results.correspondencesRatio, 0.99f);
  map.determineMatching3D(&points, CPose3D(50, 0, 0, 0, 0, 0), pairs, params, results);
  EXPECT_EQ(results.correspondencesRatio, 0.0f);
  map.determineMatching2D(&points, mrpt::poses::CPose2D(), pairs, params, results);
  EXPECT_GT(results.correspondencesRatio, 0.99f);
}

TEST(Matching, RatioIsHigherAtTheTruth) {
  const CSemanticContinuousMap map = roomMap();
  const CSemanticContinuousMap other = roomMap();
  mrpt::maps::TMatchingRatioParams params;
  params.maxDistForCorr = 0.15f;
  const float here = map.compute3DMatchingRatio(&other, CPose3D(), params);
  EXPECT_FLOAT_EQ(here, 1.0f);
  EXPECT_LT(map.compute3DMatchingRatio(&other, CPose3D(20, 0, 0, 0, 0, 0), params), 0.1f);
}

TEST(Matching, FindsTheSemanticMapInASetOfMaps) {
  const CSemanticContinuousMap map = roomMap();
  mrpt::maps::CMultiMetricMap set;  // as map-partition hands it over
  EXPECT_THROW(map.compute3DMatchingRatio(&set, CPose3D(), {}), std::invalid_argument);
  set.maps.push_back(mrpt::maps::COccupancyGridMap2D::Create());
  set.maps.push_back(std::make_shared<CSemanticContinuousMap>(map));
  EXPECT_FLOAT_EQ(map.compute3DMatchingRatio(&set, CPose3D(), {}), 1.0f);
  EXPECT_LT(map.compute3DMatchingRatio(&set, CPose3D(20, 0, 0, 0, 0, 0), {}), 0.1f);
}

TEST(Matching, NeedsPointsOnTheOtherSide) {
  const CSemanticContinuousMap map = roomMap();
  const mrpt::maps::COccupancyGridMap2D grid;
  EXPECT_THROW(map.compute3DMatchingRatio(&grid, CPose3D(), {}), std::invalid_argument);
  EXPECT_THROW(map.compute3DMatchingRatio(nullptr, CPose3D(), {}), std::invalid_argument);
}

TEST(Matching, SquareDistanceIsToTheNearestOccupiedVoxel) {
  const CSemanticContinuousMap map = roomMap();
  const float at_wall = map.squareDistanceToClosestCorrespondence(3.0f, 0.0f);
  const float in_middle = map.squareDistanceToClosestCorrespondence(0.0f, 0.0f);
  EXPECT_LT(at_wall, 0.05f);
  EXPECT_GT(in_middle, 1.0f);
  EXPECT_EQ(CSemanticContinuousMap().squareDistanceToClosestCorrespondence(0, 0),
            std::numeric_limits<float>::max());
}

TEST(Matching, PairsOfDifferentClassesAreLeftOut) {
  const CSemanticContinuousMap map = roomMap();  // of walls
  const std::vector<Eigen::Vector3f> points = roomPoints();
  std::vector<float> labels(points.size(), 50);                       // wall
  for (std::size_t i = 0; i < labels.size(); i += 4) labels[i] = 40;  // road
  for (std::size_t i = 1; i < labels.size(); i += 4) labels[i] = 77;  // says nothing
  const auto cloud = sample::pointCloud(points, labels);
  mrpt::maps::TMatchingParams params;
  params.maxDistForCorrespondence = 0.3f;
  mrpt::tfest::TMatchingPairList pairs;
  mrpt::maps::TMatchingExtraResults results;
  map.determineMatching3D(cloud->pointcloud.get(), CPose3D(), pairs, params, results);
  EXPECT_NEAR(results.correspondencesRatio, 0.75, 0.01);
  EXPECT_NEAR(static_cast<double>(pairs.size()), 0.75 * static_cast<double>(points.size()), 10);
  for (const auto& pair : pairs) EXPECT_NE(pair.localIdx % 4, 0u);

  CSemanticContinuousMap road_room = sample::sampleMap();
  road_room.insertObservation(*sample::pointCloud(points, std::vector<float>(points.size(), 40)));
  map.determineMatching3D(&road_room, CPose3D(), pairs, params, results);
  EXPECT_EQ(pairs.size(), 0u);
  EXPECT_EQ(results.correspondencesRatio, 0);
  const CSemanticContinuousMap wall_room = roomMap();
  map.determineMatching3D(&wall_room, CPose3D(), pairs, params, results);
  EXPECT_GT(results.correspondencesRatio, 0.99f);
}

/// Points on the walls of the room, 0.03 m farther out than borders of voxels, none at a lattice.
mrpt::maps::CSimplePointsMap shiftedRoom() {
  mrpt::maps::CSimplePointsMap points;
  for (const Eigen::Vector3f& p : roomPoints(0.13f)) {
    const float s = 1.01f;
    points.insertPoint(s * p.x(), 1.015f * p.y(), p.z() + 0.017f);
  }
  // Something to hold it in height.
  for (float x = -2.8f; x < 2.8f; x += 0.13f)
    for (float y = -1.8f; y < 1.8f; y += 0.13f) points.insertPoint(x, y, -1.03f);
  return points;
}

CSemanticContinuousMap mapOf(const mrpt::maps::CSimplePointsMap& points) {
  mrpt::obs::CObservationPointCloud observation;
  observation.pointcloud = std::make_shared<mrpt::maps::CSimplePointsMap>(points);
  CSemanticContinuousMap map = sample::sampleMap();
  map.insertionOptions.point_labels = PointLabels::None;
  map.insertObservation(observation);
  return map;
}

TEST(Matching, SurfacesAreThinnerThanTheirVoxels) {
  constexpr double kWall = 3.03;
  Options options;
  options.method = Method::SeeCsom;
  SemanticMap map(options);
  Scan scan;
  for (float z = -1; z < 1; z += 0.13f)
    for (float y = -2; y < 2; y += 0.13f) {
      scan.points.emplace_back(static_cast<float>(kWall), y, z);
      scan.labels.push_back(1);
    }
  map.insert(scan);
  const auto surfaces = makeSurfacePoints(map);
  // Away from its borders the wall is two voxels thick, whose centres are 0.13 and 0.07 m off.
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < surfaces->points.size(); ++i) {
    float x = 0;
    float y = 0;
    float z = 0;
    surfaces->points.getPoint(i, x, y, z);
    EXPECT_EQ(surfaces->classes.at(i), 1);
    if (std::abs(y) > 1.2f || std::abs(z) > 0.5f) continue;
    sum += (x - kWall) * (x - kWall);
    ++count;
  }
  EXPECT_GT(count, 50);
  EXPECT_LT(std::sqrt(sum / count), 0.05);
}

TEST(Matching, IcpAlignsAScanIn3d) {
  const mrpt::maps::CSimplePointsMap scan = shiftedRoom();
  const CSemanticContinuousMap map = mapOf(scan);
  mrpt::slam::CICP icp;
  icp.options.ICP_algorithm = mrpt::slam::icpClassic;
  icp.options.thresholdDist = 0.6;
  icp.options.thresholdAng = 0;
  icp.options.ALFA = 0.7;
  icp.options.smallestThresholdDist = 0.2;
  icp.options.maxIterations = 100;
  const CPose3D wrong(0.15, -0.12, 0.1, 0.05, 0.02, -0.02);
  mrpt::slam::CICP::TReturnInfo info;
  const auto found = icp.Align3D(&map, &scan, wrong, info);
  const CPose3D error = found->getMeanVal();
  std::cout << "error of the aligned pose: " << error << "\n";
  EXPECT_GT(info.goodness, 0.9);
  EXPECT_LT(error.norm(), 0.05);
  for (const double angle : {error.yaw(), error.pitch(), error.roll()})
    EXPECT_LT(std::abs(angle), 0.02);
}

}  // namespace
}  // namespace csom
