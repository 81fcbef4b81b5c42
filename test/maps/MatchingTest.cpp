// SPDX-License-Identifier: BSD-3-Clause
// Matching against other maps prefers the true pose.
#include <csom/maps/CSemanticContinuousMap.h>
#include <gtest/gtest.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/poses/CPose2D.h>

#include <limits>
#include <thread>
#include <vector>

#include "SampleObservations.h"

namespace csom {
namespace {

using mrpt::poses::CPose3D;
using testing::roomCloud;
using testing::roomMap;
using testing::roomPoints;

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

TEST(Matching, isTheSameFromManyThreads) {
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

TEST(Matching, findsItsOwnPoints) {
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

TEST(Matching, ratioIsHigherAtTheTruth) {
  const CSemanticContinuousMap map = roomMap();
  const CSemanticContinuousMap other = roomMap();
  mrpt::maps::TMatchingRatioParams params;
  params.maxDistForCorr = 0.15f;
  const float here = map.compute3DMatchingRatio(&other, CPose3D(), params);
  EXPECT_FLOAT_EQ(here, 1.0f);
  EXPECT_LT(map.compute3DMatchingRatio(&other, CPose3D(20, 0, 0, 0, 0, 0), params), 0.1f);
}

TEST(Matching, needsPointsOnTheOtherSide) {
  const CSemanticContinuousMap map = roomMap();
  const mrpt::maps::COccupancyGridMap2D grid;
  EXPECT_THROW(map.compute3DMatchingRatio(&grid, CPose3D(), {}), std::invalid_argument);
  EXPECT_THROW(map.compute3DMatchingRatio(nullptr, CPose3D(), {}), std::invalid_argument);
}

TEST(Matching, squareDistanceIsToTheNearestOccupiedVoxel) {
  const CSemanticContinuousMap map = roomMap();
  const float at_wall = map.squareDistanceToClosestCorrespondence(3.0f, 0.0f);
  const float in_middle = map.squareDistanceToClosestCorrespondence(0.0f, 0.0f);
  EXPECT_LT(at_wall, 0.05f);
  EXPECT_GT(in_middle, 1.0f);
  EXPECT_EQ(CSemanticContinuousMap().squareDistanceToClosestCorrespondence(0, 0),
            std::numeric_limits<float>::max());
}

}  // namespace
}  // namespace csom
