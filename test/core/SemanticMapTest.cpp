// SPDX-License-Identifier: BSD-3-Clause
// The map as its user sees it.
#include <csom/core/SemanticMap.h>
#include <gtest/gtest.h>

#include <thread>

#include "core/RandomScans.h"

namespace csom {
namespace {

/// A floor of class 1 and a wall of class 2, seen from one metre above the floor.
Scan corner() {
  Scan scan;
  scan.origin = {0, 0, 1};
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j) {
      const float u = 0.1F * static_cast<float>(i);
      const float v = 0.1F * static_cast<float>(j);
      scan.points.emplace_back(u, v - 2, -1.05F);
      scan.labels.push_back(1);
      scan.points.emplace_back(4.05F, v - 2, u - 1);
      scan.labels.push_back(2);
    }
  return scan;
}

Options cornerOptions() {
  Options options;
  options.number_of_classes = 3;
  options.resolution = 0.2;
  options.scan.ds_resolution = 0.1;
  return options;
}

TEST(SemanticMap, KnowsFloorAndWall) {
  SemanticMap map(cornerOptions());
  EXPECT_TRUE(map.empty());
  EXPECT_FALSE(map.boundingBox());
  const ScanReport report = map.insert(corner());
  EXPECT_EQ(report.points, 3200U);
  EXPECT_EQ(report.rejectedTotal(), 0U);
  EXPECT_GT(report.blocks_filled, report.blocks_observed);
  EXPECT_EQ(report.voxels_updated, map.knownVoxelCount());
  EXPECT_EQ(map.at({1, 0, -0.05}).mostLikelyClass(), 1);
  EXPECT_EQ(map.at({4.05, 0, 1.5}).mostLikelyClass(), 2);
  EXPECT_GT(map.at({4.05, 0, 1.5}).probability(2), 0.9);
  EXPECT_EQ(map.at({1, 0, 3}).state(), VoxelState::Unknown);
  EXPECT_EQ(map.at({1e300, 0, 3}).state(), VoxelState::Unknown);
  EXPECT_EQ(map.voxel({2000000000, 0, 0}).state(), VoxelState::Unknown);
  EXPECT_GT(map.memoryBytes(), 0U);
  map.clear();
  EXPECT_TRUE(map.empty());
  EXPECT_EQ(map.knownVoxelCount(), 0U);
}

TEST(SemanticMap, FreeSpaceOfBothKindsLiesBetweenSensorAndSurface) {
  for (const FreeSpace kind : {FreeSpace::Sampled, FreeSpace::Raycast}) {
    Options options = cornerOptions();
    options.free_space.mode = kind;
    options.free_space.resolution = 0.3;
    SemanticMap map(options);
    map.insert(corner());
    EXPECT_EQ(map.at({2, 0, 0.95}).state(), VoxelState::Free) << toString(kind);
    EXPECT_EQ(map.at({4.05, 0, 1.5}).state(), VoxelState::Occupied) << toString(kind);
    EXPECT_EQ(map.at({5, 0, 1}).state(), VoxelState::Unknown) << toString(kind);
  }
}

TEST(SemanticMap, AFloorOnTheBorderOfVoxelsIsNotLost) {
  Options options;
  options.number_of_classes = 2;
  options.resolution = 0.25;
  Scan scan;
  scan.origin = {0, 0, 0};
  for (int x = -20; x < 20; ++x)
    for (int y = -20; y < 20; ++y)
      scan.points.emplace_back(0.125F * static_cast<float>(x) + 0.0625F,
                               0.125F * static_cast<float>(y) + 0.0625F, 0.0F);
  scan.labels.assign(scan.points.size(), 1);
  SemanticMap map(options);
  map.insert(scan);
  for (int x = -10; x < 10; ++x)
    for (int y = -10; y < 10; ++y) {
      EXPECT_EQ(map.voxel({x, y, 0}).state(), VoxelState::Occupied) << x << ' ' << y;
      EXPECT_NE(map.voxel({x, y, -1}).state(), VoxelState::Occupied) << x << ' ' << y;
    }
}

TEST(SemanticMap, AScanThatFillsNothingLeavesTheMapEmpty) {
  Options options = cornerOptions();
  options.method = Method::SeeCsom;
  options.see_csom.context_threshold = 1;  // no block reaches it
  SemanticMap map(options);
  const ScanReport report = map.insert(corner());
  EXPECT_GT(report.blocks_observed, 0U);
  EXPECT_EQ(report.blocks_filled, 0U);
  EXPECT_TRUE(map.empty());
}

TEST(SemanticMap, InvalidOptionsAndUnequalMapsThrow) {
  Options bad;
  bad.resolution = 0;
  EXPECT_THROW(SemanticMap{bad}, OptionError);
  SemanticMap a(cornerOptions());
  Options other = cornerOptions();
  other.number_of_classes = 4;
  EXPECT_THROW(a.merge(SemanticMap(other)), std::invalid_argument);
}

TEST(SemanticMap, CopiesAreIndependent) {
  SemanticMap map(cornerOptions());
  map.insert(corner());
  const std::string before = test::bytesOf(map);
  SemanticMap copy = map;
  copy.insert(corner());
  EXPECT_EQ(test::bytesOf(map), before);
  EXPECT_NE(test::bytesOf(copy), before);
}

TEST(SemanticMap, RecordsMakeTheSameMapAgain) {
  SemanticMap map(cornerOptions());
  map.insert(corner());
  SemanticMap read(cornerOptions());
  for (const auto& [index, chunk] : map.chunks().sorted())
    read.addChunkRecord(index, chunk->record(), chunk->recordSize());
  EXPECT_EQ(test::bytesOf(read), test::bytesOf(map));
  const auto [index, chunk] = map.chunks().sorted().front();
  EXPECT_THROW(read.addChunkRecord({1 << 20, 0, 0}, chunk->record(), chunk->recordSize()),
               std::runtime_error);
}

TEST(SemanticMap, BlocksAtTheEndOfTheIndexRangeAreSafe) {
  Options options = cornerOptions();
  options.scan.ds_resolution = 0;
  SemanticMap map(options);
  Scan scan;
  const double end = options.resolution * kMaxVoxelIndex;
  for (const double sign : {-1.0, 1.0}) {
    scan.origin = Eigen::Vector3d::Constant(sign * (end - 0.1));
    scan.points = {{0, 0, 0}, Eigen::Vector3f::Constant(static_cast<float>(sign) * 5)};
    scan.labels = {1, 1};
    const ScanReport report = map.insert(scan);
    EXPECT_EQ(report.rejected[static_cast<std::size_t>(RejectReason::OutsideIndexRange)], 1U);
    EXPECT_EQ(map.at(scan.origin).state(), VoxelState::Occupied);
  }
}

TEST(SemanticMap, ManyThreadsMayAskAtOnce) {
  SemanticMap map(cornerOptions());
  map.insert(corner());
  std::vector<std::size_t> occupied(4, 0);
  std::vector<std::thread> threads;
  for (std::size_t& count : occupied) {
    threads.emplace_back([&map, &count] {
      const SemanticMap copy = map;
      map.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
        if (voxel.state() == VoxelState::Occupied && copy.voxel(v).known() &&
            map.castRay({0, 0, 1}, map.grid().center(v) - Eigen::Vector3d(0, 0, 1), 10) &&
            map.nearestOccupied(map.grid().center(v), 0.5))
          ++count;
      });
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_GT(occupied[0], 0U);
  for (const std::size_t count : occupied) EXPECT_EQ(count, occupied[0]);
}

}  // namespace
}  // namespace csom
