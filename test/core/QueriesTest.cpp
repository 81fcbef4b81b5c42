// SPDX-License-Identifier: BSD-3-Clause
// Ray casting, nearest voxels and boxes against brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/RandomScans.h"

namespace csom::test {
namespace {

SemanticMap randomMap(std::uint64_t seed) {
  RandomCase random(seed);
  Options options;
  options.number_of_classes = 5;
  options.resolution = 0.25;
  options.free_space.mode = FreeSpace::Sampled;
  SemanticMap map(options);
  for (int i = 0; i < 3; ++i) {
    Scan scan = random.scan(options, 400);
    scan.origin = {random.real(-2, 2), random.real(-2, 2), random.real(-2, 2)};
    map.insert(scan);
  }
  return map;
}

struct Voxel {
  VoxelIndex index;
  ClassId class_id;
};

std::vector<Voxel> occupiedVoxels(const SemanticMap& map) {
  std::vector<Voxel> occupied;
  map.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
    if (voxel.state() == VoxelState::Occupied) occupied.push_back({v, voxel.mostLikelyClass()});
  });
  return occupied;
}

/// Where a ray enters an axis-aligned cube; negative if it misses.
double entry(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
             const Eigen::Vector3d& lower, double edge) {
  double in = 0;
  double out = 1e300;
  for (int a = 0; a < 3; ++a) {
    const double t0 = (lower[a] - origin[a]) / direction[a];
    const double t1 = (lower[a] + edge - origin[a]) / direction[a];
    in = std::max(in, std::min(t0, t1));
    out = std::min(out, std::max(t0, t1));
  }
  return in < out ? in : -1;
}

TEST(CastRay, FindsTheFirstOccupiedVoxelOfBruteForce) {
  int hits = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const SemanticMap map = randomMap(seed);
    const std::vector<Voxel> occupied = occupiedVoxels(map);
    RandomCase random(seed + 100);
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector3d origin(random.real(-5, 5), random.real(-5, 5), random.real(-3, 3));
      const Eigen::Vector3d direction(random.real(-1, 1), random.real(-1, 1), random.real(-1, 1));
      const double max_range = random.real(0.5, 8);
      double nearest = max_range;
      for (const Voxel& v : occupied) {
        const double t = entry(origin, direction.normalized(), map.grid().lowerCorner(v.index),
                               map.grid().resolution());
        if (t >= 0) nearest = std::min(nearest, t);
      }
      const auto hit = map.castRay(origin, direction, max_range);
      ASSERT_EQ(hit.has_value(), nearest < max_range);
      if (!hit) continue;
      ++hits;
      ASSERT_NEAR(hit->distance, nearest, 1e-9);
      ASSERT_NEAR((hit->point - origin).norm(), nearest, 1e-9);
      ASSERT_EQ(map.voxel(hit->voxel).mostLikelyClass(), hit->class_id);
    }
  }
  EXPECT_GT(hits, 100);
}

TEST(CastRay, HandlesEdgesOfTheQuestion) {
  Options options;
  options.resolution = 1;
  options.method = Method::SCsm;
  SemanticMap map(options);
  Scan scan;
  scan.points = {{3.5F, 0.5F, 0.5F}};
  scan.labels = {1};
  map.insert(scan);
  const Eigen::Vector3d origin(0.5, 0.5, 0.5);
  EXPECT_TRUE(map.castRay(origin, {1, 0, 0}, 1e12));
  EXPECT_TRUE(map.castRay(origin, {1e-9, 0, 0}, 5)) << "direction need not be normalised";
  EXPECT_FALSE(map.castRay(origin, {1, 0, 0}, 2)) << "the voxel begins at 2.5 m";
  EXPECT_TRUE(map.castRay({3.5, 0.5, 0.5}, {0, 1, 0}, 1)) << "the voxel of the origin counts";
  EXPECT_EQ(map.castRay({3.5, 0.5, 0.5}, {0, 1, 0}, 1)->distance, 0);
  EXPECT_FALSE(map.castRay(origin, {1, 0, 0}, 10, true)) << "unknown space lies before it";
  EXPECT_FALSE(map.castRay(origin, {0, 0, 0}, 10));
  EXPECT_FALSE(map.castRay(origin, {NAN, 0, 0}, 10));
  EXPECT_FALSE(map.castRay({NAN, 0, 0}, {1, 0, 0}, 10));
  EXPECT_FALSE(map.castRay(origin, {1, 0, 0}, -1));
}

TEST(CastRay, B9_TheLastLayersOfTheGridAreReached) {
  Options options;
  options.resolution = 0.1;
  options.method = Method::SCsm;
  // Points stay away from the last layers, but kernels and other programs may fill them.
  SemanticMap source(options);
  Scan scan;
  scan.points = {{0.05F, 0.05F, 0.05F}};
  scan.labels = {1};
  source.insert(scan);
  const auto chunk = source.chunks().sorted().front();
  for (const int side : {-1, 1}) {
    SemanticMap map(options);
    const ChunkIndex last{side * kMaxChunkIndex, 0, 0};
    map.addChunkRecord(last, chunk.second->record(), chunk.second->recordSize());
    const VoxelIndex occupied = voxelOfChunk(last, 0);
    ASSERT_EQ(map.voxel(occupied).state(), VoxelState::Occupied);
    const Eigen::Vector3d center = map.grid().center(occupied);
    EXPECT_EQ(map.at(center).state(), VoxelState::Occupied);
    for (const Eigen::Vector3d& direction :
         {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(0, 0, 1)}) {
      const auto hit = map.castRay(center, direction, 10);
      ASSERT_TRUE(hit) << side << ", " << direction.transpose();
      EXPECT_EQ(hit->voxel, occupied);
    }
    const auto from_inside =
        map.castRay(center - Eigen::Vector3d(side * 5.0, 0, 0), Eigen::Vector3d(side, 0, 0), 1e9);
    ASSERT_TRUE(from_inside);
    EXPECT_EQ(from_inside->voxel, occupied);
    const auto nearest = map.nearestOccupied(center, 1);
    ASSERT_TRUE(nearest);
    EXPECT_EQ(nearest->voxel, occupied);
    // The ray ends where indices end.
    EXPECT_FALSE(map.castRay(map.grid().center(voxelOfChunk(last, 511)),
                             Eigen::Vector3d(side, 1e-9, 0), 1e9));
  }
  EXPECT_FALSE(SemanticMap(options).castRay({1e9, 0, 0}, {1, 0, 0}, 10));
}

TEST(NearestOccupied, IsThatOfBruteForce) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const SemanticMap map = randomMap(seed);
    const std::vector<Voxel> occupied = occupiedVoxels(map);
    RandomCase random(seed + 200);
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector3d point(random.real(-8, 8), random.real(-8, 8), random.real(-5, 5));
      const double max_distance = random.oneOf<double>({0.2, 1.0, 5.0, INFINITY});
      const bool by_class = random.integer(0, 1) == 1;
      double nearest = INFINITY;
      for (const Voxel& v : occupied) {
        if (!by_class || v.class_id == 2)
          nearest = std::min(nearest, (map.grid().center(v.index) - point).norm());
      }
      const auto found = by_class ? map.nearestOccupied(point, max_distance, ClassId{2})
                                  : map.nearestOccupied(point, max_distance);
      ASSERT_EQ(found.has_value(), nearest <= max_distance && std::isfinite(nearest));
      if (found) {
        ASSERT_NEAR(found->distance, nearest, 1e-12);
      }
    }
  }
}

TEST(Boxes, IterationAndBoundingBoxAgree) {
  const SemanticMap map = randomMap(3);
  std::size_t all = 0;
  VoxelBox expected{{1 << 20, 1 << 20, 1 << 20}, {-(1 << 20), -(1 << 20), -(1 << 20)}};
  const VoxelBox box{{-3, -5, -2}, {4, 2, 6}};
  std::vector<VoxelIndex> inside;
  map.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
    EXPECT_TRUE(voxel.known());
    ++all;
    expected.min = {std::min(expected.min.x, v.x), std::min(expected.min.y, v.y),
                    std::min(expected.min.z, v.z)};
    expected.max = {std::max(expected.max.x, v.x), std::max(expected.max.y, v.y),
                    std::max(expected.max.z, v.z)};
    if (v.x >= -3 && v.x <= 4 && v.y >= -5 && v.y <= 2 && v.z >= -2 && v.z <= 6)
      inside.push_back(v);
  });
  EXPECT_EQ(all, map.knownVoxelCount());
  const auto found = map.boundingBox();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->min, expected.min);
  EXPECT_EQ(found->max, expected.max);
  std::vector<VoxelIndex> visited;
  map.forEachVoxelInBox(box,
                        [&](const VoxelIndex& v, const DirichletVoxel&) { visited.push_back(v); });
  EXPECT_FALSE(inside.empty());
  EXPECT_EQ(visited, inside);
}

}  // namespace
}  // namespace csom::test
