// SPDX-License-Identifier: BSD-3-Clause
// How well an observation fits to the map: by distances, along beams, and by labels.
#include <csom/core/Error.h>
#include <csom/maps/CSemanticContinuousMap.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <cmath>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include "SampleObservations.h"

namespace csom {
namespace {

using mrpt::poses::CPose3D;
using sample::roomCloud;
using sample::roomMap;
using sample::roomPoints;
using sample::sampleMap;

TEST(Likelihood, FallsWithTheDistanceFromTheTruth) {
  const CSemanticContinuousMap map = roomMap();
  double previous = map.computeObservationLikelihood(*roomCloud(), CPose3D());
  for (const double offset : {0.3, 0.6, 0.9}) {
    const double here =
        map.computeObservationLikelihood(*roomCloud(), CPose3D(offset, offset, 0, 0, 0, 0));
    EXPECT_LT(here, previous) << offset;
    previous = here;
  }
  EXPECT_LT(map.computeObservationLikelihood(*roomCloud(), CPose3D(0, 0, 0, 0.2, 0, 0)),
            map.computeObservationLikelihood(*roomCloud(), CPose3D(0, 0, 0, 0.02, 0, 0)));
}

TEST(Likelihood, FollowsItsFormula) {
  CSemanticContinuousMap map = sampleMap();
  map.insertObservation(*roomCloud());
  map.likelihoodOptions = {};
  map.likelihoodOptions.decimation = 1;
  map.likelihoodOptions.max_distance = 0.5;
  map.likelihoodOptions.sigma = 0.1;
  // Far outside every point is at max_distance: -0.5 * 0.25 / 0.01.
  EXPECT_DOUBLE_EQ(map.computeObservationLikelihood(*roomCloud(), CPose3D(100, 0, 0, 0, 0, 0)),
                   -12.5);
}

TEST(Likelihood, SaysNothingWithoutPoints) {
  const CSemanticContinuousMap map = roomMap();
  EXPECT_FALSE(map.canComputeObservationLikelihood(mrpt::obs::CObservationOdometry()));
  EXPECT_EQ(map.computeObservationLikelihood(mrpt::obs::CObservationOdometry(), CPose3D()), 0);
  EXPECT_EQ(map.computeObservationLikelihood(mrpt::obs::CObservationPointCloud(), CPose3D()), 0);
}

TEST(Likelihood, SaysNothingOfACloudWhoseFileIsMissing) {
  const CSemanticContinuousMap map = roomMap();
  using mrpt::obs::CObservationPointCloud;
  for (const auto format : {CObservationPointCloud::ExternalStorageFormat::MRPT_Serialization,
                            CObservationPointCloud::ExternalStorageFormat::KittiBinFile}) {
    CObservationPointCloud observation;
    observation.setAsExternalStorage("csom_no_such_file.bin", format);
    ASSERT_TRUE(map.canComputeObservationLikelihood(observation));
    EXPECT_EQ(map.computeObservationLikelihood(observation, CPose3D()), 0);
  }
}

TEST(Likelihood, WrongOptionsAreNoDamagedObservation) {
  CSemanticContinuousMap map = roomMap();
  map.insertionOptions.unlabelled_class = "lawn";
  EXPECT_THROW(map.computeObservationLikelihood(*roomCloud(), CPose3D()), ConfigError);
}

/// One observation of every kind that carries points, each with walls around the sensor.
std::vector<mrpt::obs::CObservation::Ptr> everyKind() {
  return {sample::laserScan(361, 3.0f), sample::rangeCamera(), sample::velodyneRoom(),
          sample::rotatingScan(), roomCloud()};
}

TEST(Likelihood, IsHighestAtTheTruthForEveryKind) {
  for (const LikelihoodMethod method : {LikelihoodMethod::Field, LikelihoodMethod::Beam}) {
    for (const auto& observation : everyKind()) {
      SCOPED_TRACE(toString(method) + ", " + observation->GetRuntimeClass()->className);
      CSemanticContinuousMap map = sampleMap();
      map.insertionOptions.scan_2d_class = "wall";
      map.likelihoodOptions.method = method;
      map.likelihoodOptions.decimation = 1;
      ASSERT_TRUE(map.insertObservation(*observation));
      ASSERT_TRUE(map.canComputeObservationLikelihood(*observation));
      const double truth = map.computeObservationLikelihood(*observation, CPose3D());
      EXPECT_LE(truth, 0);
      EXPECT_GT(truth, -1.5);
      for (const CPose3D& pose : {CPose3D(0.6, 0, 0, 0, 0, 0), CPose3D(-0.6, 0, 0, 0, 0, 0)})
        EXPECT_LT(map.computeObservationLikelihood(*observation, pose), truth) << pose;
    }
  }
}

TEST(Likelihood, CannotBeComputedOfWhatHoldsNoPoints) {
  const CSemanticContinuousMap map = roomMap();
  auto unknown_rows = sample::rotatingScan();
  unknown_rows->lidarModel = "OS1";
  unknown_rows->rowCount = 4;
  unknown_rows->rangeImage.setZero(4, 360);
  const std::vector<mrpt::obs::CObservation::Ptr> none = {
      sample::laserScan(0),
      mrpt::obs::CObservation3DRangeScan::Create(),
      mrpt::obs::CObservationVelodyneScan::Create(),
      mrpt::obs::CObservationRotatingScan::Create(),
      mrpt::obs::CObservationPointCloud::Create(),
      unknown_rows,
      mrpt::obs::CObservationImage::Create(),
      mrpt::obs::CObservationOdometry::Create()};
  for (const auto& observation : none) {
    EXPECT_FALSE(map.canComputeObservationLikelihood(*observation))
        << observation->GetRuntimeClass()->className;
    EXPECT_EQ(map.computeObservationLikelihood(*observation, CPose3D()), 0);
  }
}

TEST(Likelihood, FieldFindsTheNearestVoxelOrOneHardlyFarther) {
  const CSemanticContinuousMap map = roomMap();
  const double diagonal = std::sqrt(3.0) * map.map().grid().resolution();
  constexpr double kMaxDistance = 1.5;
  const NearestVoxelField field;
  NearestVoxelReader reader(field, map.map(), kMaxDistance);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-5, 5);
  double excess = 0;
  int found_points = 0;
  int missed_points = 0;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d point(coordinate(random), coordinate(random), coordinate(random) / 2);
    const auto exact = map.map().nearestOccupied(point, kMaxDistance);
    const auto found = reader.nearest(point);
    if (!exact) {
      EXPECT_FALSE(found);
      continue;
    }
    if (!found) {  // only where the nearest is almost too far
      EXPECT_GT(exact->distance + diagonal, kMaxDistance);
      ++missed_points;
      continue;
    }
    EXPECT_EQ(map.map().voxel(found->voxel).state(), VoxelState::Occupied);
    EXPECT_GE(found->distance, exact->distance - 1e-12);
    EXPECT_LE(found->distance, exact->distance + diagonal);
    excess += found->distance - exact->distance;
    ++found_points;
  }
  EXPECT_GT(found_points, 2000);
  EXPECT_LT(missed_points, found_points / 100);
  EXPECT_LT(excess / found_points, 0.02 * diagonal);
}

TEST(Likelihood, FollowsInsertions) {
  CSemanticContinuousMap map = roomMap();
  const CPose3D outside(0, 8, 0, 0, 0, 0);
  const double before = map.computeObservationLikelihood(*roomCloud(), outside);
  map.insertObservation(*roomCloud(), outside);
  const double after = map.computeObservationLikelihood(*roomCloud(), outside);
  EXPECT_GT(after, before + 1);
  // A copy starts without what the original remembers.
  EXPECT_EQ(CSemanticContinuousMap(map).computeObservationLikelihood(*roomCloud(), outside), after);
  map.clear();
  EXPECT_EQ(map.computeObservationLikelihood(*roomCloud(), outside), -8);  // all at max_distance
}

TEST(Likelihood, FollowsMaxDistance) {
  CSemanticContinuousMap map = roomMap();
  const CPose3D beside(0.7, 0.7, 0, 0, 0, 0);
  for (const double max_distance : {1.0, 0.3, 1.0, 2.0}) {
    map.likelihoodOptions.max_distance = max_distance;
    EXPECT_EQ(map.computeObservationLikelihood(*roomCloud(), beside),
              CSemanticContinuousMap(map).computeObservationLikelihood(*roomCloud(), beside))
        << max_distance;
  }
}

TEST(Likelihood, SeesThatAnObservationHasChanged) {
  const CSemanticContinuousMap map = roomMap();
  const auto observation = roomCloud();
  const double before = map.computeObservationLikelihood(*observation, CPose3D());
  auto& cloud = dynamic_cast<mrpt::maps::CPointsMapXYZI&>(*observation->pointcloud);
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.setPointFast(i, 0.5f, 0.5f, 0);
  EXPECT_LT(map.computeObservationLikelihood(*observation, CPose3D()), before - 1);
}

TEST(Likelihood, UsesOnePointOutOfSoMany) {
  CSemanticContinuousMap map = roomMap();
  std::vector<Eigen::Vector3f> points(40, {100, 0, 0});  // all but every fourth one far outside
  for (std::size_t i = 0; i < points.size(); i += 4) points[i] = {2.9f, 0.1f, 0.1f};
  const auto cloud = sample::pointCloud(points, std::vector<float>(points.size(), 50));
  map.likelihoodOptions.decimation = 4;
  const double fitting = map.computeObservationLikelihood(*cloud, CPose3D());
  EXPECT_GT(fitting, -0.5);
  map.likelihoodOptions.decimation = 1;
  EXPECT_NEAR(map.computeObservationLikelihood(*cloud, CPose3D()), (fitting + 3 * -8) / 4, 1e-9);
}

/// Two rooms that differ in nothing but the class of their walls, 20 m apart.
CSemanticContinuousMap roadRoomAndWallRoom() {
  CSemanticContinuousMap map = sampleMap();
  const std::vector<Eigen::Vector3f> points = roomPoints();
  map.insertObservation(*sample::pointCloud(points, std::vector<float>(points.size(), 40)));
  map.insertObservation(*roomCloud(), CPose3D(20, 0, 0, 0, 0, 0));
  return map;
}

TEST(Likelihood, LabelsTellRoomsOfTheSameShapeApart) {
  for (const LikelihoodMethod method : {LikelihoodMethod::Field, LikelihoodMethod::Beam}) {
    SCOPED_TRACE(toString(method));
    CSemanticContinuousMap map = roadRoomAndWallRoom();
    map.likelihoodOptions.method = method;
    const auto both = [&] {
      return std::pair(map.computeObservationLikelihood(*roomCloud(), CPose3D(20, 0, 0, 0, 0, 0)),
                       map.computeObservationLikelihood(*roomCloud(), CPose3D()));
    };
    const auto [right, wrong] = both();
    EXPECT_NEAR(right, wrong, 0.02) << "labels count although semantic_weight is 0";

    map.likelihoodOptions.semantic_weight = 2;
    map.likelihoodOptions.label_error = 0.1;
    const auto [right_label, wrong_label] = both();
    // Two classes can be said (road and wall): a right label has 0.95 of the share, a wrong one
    // 0.05, but for the prior and points without a match.
    EXPECT_NEAR(right_label - right, 2 * std::log(0.95), 0.1);
    EXPECT_NEAR(wrong_label - wrong, 2 * std::log(0.05), 0.2);
  }
}

TEST(Likelihood, LabelsThatSayNothingDoNotCount) {
  CSemanticContinuousMap map = roadRoomAndWallRoom();
  const std::vector<Eigen::Vector3f> points = roomPoints();
  const auto unknown = sample::pointCloud(points, std::vector<float>(points.size(), 77));
  const double without = map.computeObservationLikelihood(*unknown, CPose3D());
  map.likelihoodOptions.semantic_weight = 5;
  EXPECT_EQ(map.computeObservationLikelihood(*unknown, CPose3D()), without);
  EXPECT_NE(map.computeObservationLikelihood(*roomCloud(), CPose3D()), without);
}

TEST(Likelihood, PointsWithoutAVoxelHaveAllClassesAlike) {
  CSemanticContinuousMap map = roadRoomAndWallRoom();
  map.likelihoodOptions.semantic_weight = 3;
  const CPose3D far(500, 0, 0, 0, 0, 0);
  // Road, wall and unlabelled: the last one is outvoted by any label, so that it is none to say.
  const bool unlabelled = map.map().options().unlabelled_class_id != 0;
  EXPECT_NEAR(map.computeObservationLikelihood(*roomCloud(), far),
              -8 + 3 * std::log(1.0 / (unlabelled ? 2 : 3)), 1e-9);
}

TEST(Likelihood, BeamsDoNotPassThroughWalls) {
  CSemanticContinuousMap map = roomMap();
  // A point on the far wall, seen from a pose in front of the near one: the field is content.
  const auto far_wall = sample::pointCloud({{7.0f, 0.05f, 0.05f}}, {50});
  const CPose3D in_front(-4.05, 0, 0, 0, 0, 0);
  map.likelihoodOptions.decimation = 1;
  EXPECT_GT(map.computeObservationLikelihood(*far_wall, in_front), -0.5);
  map.likelihoodOptions.method = LikelihoodMethod::Beam;
  EXPECT_EQ(map.computeObservationLikelihood(*far_wall, in_front), -8);  // as far as can be
  EXPECT_GT(map.computeObservationLikelihood(*roomCloud(), CPose3D()), -0.5);
}

TEST(Likelihood, RefusesImpossibleOptions) {
  CSemanticContinuousMap map = roomMap();
  map.likelihoodOptions.label_error = 0;
  EXPECT_THROW(map.computeObservationLikelihood(*roomCloud(), CPose3D()), OptionError);
  map.likelihoodOptions.label_error = 0.1;
  map.likelihoodOptions.semantic_weight = -1;
  EXPECT_THROW(map.computeObservationLikelihood(*roomCloud(), CPose3D()), OptionError);
}

TEST(Likelihood, IsTheSameFromEightThreads) {
  for (const LikelihoodMethod method : {LikelihoodMethod::Field, LikelihoodMethod::Beam}) {
    CSemanticContinuousMap map = roadRoomAndWallRoom();
    map.likelihoodOptions.method = method;
    map.likelihoodOptions.semantic_weight = 1;
    std::vector<CPose3D> poses;
    std::vector<double> expected;
    const CSemanticContinuousMap alone(map);
    for (int i = 0; i < 24; ++i) {
      poses.emplace_back(i, 0.1 * i, 0, 0.02 * i, 0, 0);
      expected.push_back(alone.computeObservationLikelihood(*roomCloud(), poses.back()));
    }
    std::vector<std::vector<double>> values(8, std::vector<double>(poses.size()));
    std::vector<std::thread> threads;
    for (std::vector<double>& mine : values) {
      threads.emplace_back([&] {
        for (std::size_t i = 0; i < poses.size(); ++i)
          mine[i] = map.computeObservationLikelihood(*roomCloud(), poses[i]);
      });
    }
    for (std::thread& thread : threads) thread.join();
    for (const std::vector<double>& mine : values) EXPECT_EQ(mine, expected);
  }
}

}  // namespace
}  // namespace csom
