// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Grid.h>
#include <csom/core/SemanticMap.h>
#include <csom/eval/OctoMapMapper.h>
#include <gtest/gtest.h>

#include <cmath>

#include "BaselineScans.h"

namespace csom {
namespace {

using namespace test;

double logOdds(double probability) {
  return std::log(probability / (1 - probability));
}
double probabilityOf(double log_odds) {
  return 1 / (1 + std::exp(-log_odds));
}

TEST(OctoMapMapper, AddsLogOddsOfHitsAndMissesAndClampsThem) {
  OctoMapMapper mapper(baselineInput(FreeSpace::Sampled));
  const Eigen::Vector3d wall(2.05, 0.05, 0.05);
  const Eigen::Vector3d air(1.05, 0.05, 0.05);
  for (int n = 1; n <= 3; ++n) {
    mapper.insert(scanOf({2.05F, 0.05F, 0.05F}));
    EXPECT_NEAR(mapper.at(wall).occupancy, probabilityOf(n * logOdds(0.7)), 1e-6);
    EXPECT_NEAR(mapper.at(air).occupancy, probabilityOf(n * logOdds(0.4)), 1e-6);
  }
  for (int n = 0; n < 20; ++n) mapper.insert(scanOf({2.05F, 0.05F, 0.05F}));
  EXPECT_NEAR(mapper.at(wall).occupancy, 0.971, 1e-6);
  EXPECT_NEAR(mapper.at(air).occupancy, 0.1192, 1e-6);
}

TEST(OctoMapMapper, AHitIsOccupiedItsBeamFreeAndTheRestUnknown) {
  OctoMapMapper mapper(baselineInput(FreeSpace::Sampled));
  mapper.insert(scanOf({2.05F, 0.05F, 0.05F}));
  EXPECT_EQ(mapper.at({2.05, 0.05, 0.05}).class_id, 1);
  EXPECT_EQ(mapper.at({1.05, 0.05, 0.05}).class_id, kFreeClass);
  EXPECT_TRUE(mapper.at({1.05, 0.05, 0.05}).known);
  EXPECT_FALSE(mapper.at({2.15, 0.05, 0.05}).known);
  EXPECT_FALSE(mapper.at({1.05, 0.15, 0.05}).known);
  EXPECT_FALSE(mapper.at({1e7, 0, 0}).known);
}

TEST(OctoMapMapper, ItsVoxelsAreThoseOfTheGrid) {
  // Hits and voxels that beams cross, as the library's own ray casting finds them.
  Options input = baselineInput(FreeSpace::Raycast);
  OctoMapMapper mapper(input);
  input.method = Method::SCsm;
  SemanticMap map(input);
  Scan scan = randomScan(7, 30);
  // Discretised rays end in the middle of the voxel that was hit.
  for (Eigen::Vector3f& point : scan.points)
    point =
        (map.grid().center(map.grid().voxelAt(scan.origin + point.cast<double>())) - scan.origin)
            .cast<float>();
  mapper.insert(scan);
  map.insert(scan);
  std::size_t hits = 0;
  std::size_t crossed = 0;
  std::size_t different = 0;
  forEachCenter(1.5, [&](const Eigen::Vector3d& center) {
    const VoxelEstimate voxel = mapper.at(center);
    expectPlainEstimate(voxel);
    const DirichletVoxel expected = map.at(center);
    if (expected.state() == VoxelState::Occupied) {
      EXPECT_GT(voxel.occupancy, 0.5);
      ++hits;
    }
    if (expected.state() == VoxelState::Free) ++crossed;
    // Beams in single precision pass some edges of voxels on the other side.
    if (voxel.known != expected.known()) ++different;
  });
  EXPECT_EQ(hits, 30U);
  EXPECT_GT(crossed, 200U);
  EXPECT_LT(different, crossed / 50);
}

TEST(OctoMapMapper, WithoutFreeSpaceAScanUpdatesAHitOnceAndNothingElse) {
  OctoMapMapper mapper(baselineInput(FreeSpace::None));
  Scan scan = scanOf({2.04F, 0.05F, 0.05F});
  scan.points.push_back({2.06F, 0.05F, 0.05F});
  scan.labels.push_back(2);
  mapper.insert(scan);
  EXPECT_NEAR(mapper.at({2.05, 0.05, 0.05}).occupancy, 0.7, 1e-6);
  EXPECT_FALSE(mapper.at({1.05, 0.05, 0.05}).known);
}

TEST(OctoMapMapper, APointOfClassFreeIsFree) {
  OctoMapMapper mapper(baselineInput(FreeSpace::None));
  mapper.insert(scanOf({2.05F, 0.05F, 0.05F}, kFreeClass));
  EXPECT_NEAR(mapper.at({2.05, 0.05, 0.05}).occupancy, 0.4, 1e-6);
}

TEST(OctoMapMapper, TheOrderOfScansDoesNotMatterBeforeClamping) {
  OctoMapMapper forward(baselineInput(FreeSpace::Sampled));
  OctoMapMapper backward(baselineInput(FreeSpace::Sampled));
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    forward.insert(randomScan(seed, 20));
    backward.insert(randomScan(2 - seed, 20));
  }
  forEachCenter(1.2, [&](const Eigen::Vector3d& center) {
    EXPECT_EQ(forward.at(center).known, backward.at(center).known);
    EXPECT_NEAR(forward.at(center).occupancy, backward.at(center).occupancy, 1e-5);
  });
}

TEST(OctoMapMapper, RejectsWhatItCannotHold) {
  OctoMapParameters parameters;
  parameters.hit_probability = 0.3;
  EXPECT_THROW(OctoMapMapper(baselineInput(FreeSpace::None), parameters), OptionError);
  OctoMapMapper mapper(baselineInput(FreeSpace::None));
  EXPECT_THROW(mapper.insert(scanOf({4000, 0, 0})), std::invalid_argument);
}

}  // namespace
}  // namespace csom
