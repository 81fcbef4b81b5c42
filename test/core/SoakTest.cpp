// SPDX-License-Identifier: BSD-3-Clause
// Laps round a block of a town, tens of thousands of scans in one process: once the map is complete
// nothing grows, and counts end at their limit.
#include <csom/core/SemanticMap.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "core/RandomScans.h"

namespace csom::test {
namespace {

constexpr int kScansPerLap = 100;

/// CSOM_SOAK_SCANS, for a long run.
int lapsWanted() {
  const char* const text = std::getenv("CSOM_SOAK_SCANS");
  const int scans = text != nullptr ? std::atoi(text) : 20000;
  return (scans + kScansPerLap - 1) / kScansPerLap;
}

/// What a sensor sees from place `number` of a lap round a block of 30 m: the house fronts of the
/// block, the street, and a lamp post that stands in one voxel.
Scan scanOfLap(int number) {
  constexpr double kBlock = 15, kStreet = 19;
  const double turn = 2 * M_PI * number / kScansPerLap;
  Scan scan;
  scan.origin = {kStreet * std::cos(turn), kStreet * std::sin(turn), 1.5};
  const auto add = [&](double x, double y, double z, ClassId label) {
    scan.points.push_back((Eigen::Vector3d(x, y, z) - scan.origin).cast<float>());
    scan.labels.push_back(label);
  };
  for (int i = -6; i <= 6; ++i) {
    const double at = turn + 0.03 * i;
    for (int j = 0; j < 4; ++j) add(kBlock * std::cos(at), kBlock * std::sin(at), 0.3 + 0.8 * j, 1);
    add((kStreet + 0.4) * std::cos(at), (kStreet + 0.4) * std::sin(at), 0.0, 2);
  }
  for (int i = 0; i < 60; ++i) add(0.1, 0.1, 0.1 + 0.003 * i, 3);
  return scan;
}

double millisecondsOf(const std::vector<double>& times, std::size_t begin, std::size_t count) {
  double sum = 0;
  for (std::size_t i = begin; i < begin + count; ++i) sum += times.at(i);
  return sum / static_cast<double>(count);
}

class Soak : public testing::TestWithParam<Method> {};

TEST_P(Soak, NothingGrowsOnceTheMapIsComplete) {
  Options options;
  options.number_of_classes = 4;
  options.resolution = 0.4;
  options.method = GetParam();
  options.free_space.mode = FreeSpace::Raycast;
  const int laps = lapsWanted();
  ASSERT_GE(laps, 20);
  std::vector<Scan> scans;
  for (int i = 0; i < kScansPerLap; ++i) scans.push_back(scanOfLap(i));

  SemanticMap map(options);
  for (const Scan& scan : scans) map.insert(scan);
  const SemanticMap first_lap = map;
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(laps * kScansPerLap));
  std::size_t map_bytes = 0, heap_bytes = 0;
  for (int lap = 1; lap < laps; ++lap) {
    for (const Scan& scan : scans) {
      const auto start = std::chrono::steady_clock::now();
      map.insert(scan);
      const std::chrono::duration<double, std::milli> elapsed =
          std::chrono::steady_clock::now() - start;
      times.push_back(elapsed.count());
    }
    // The copy of the first lap lets go of nothing: both are complete after the second.
    if (lap == 2) {
      map_bytes = map.memoryBytes();
      heap_bytes = ::mallinfo2().uordblks;
    }
  }
  EXPECT_EQ(map.memoryBytes(), map_bytes);
  // Less than a byte for every second scan: buffers that are kept may differ by a few.
  EXPECT_LT(::mallinfo2().uordblks, heap_bytes + 10'000);
  EXPECT_EQ(map.knownVoxelCount(), first_lap.knownVoxelCount());

  std::size_t saturated = 0;
  map.chunks().forEach([&](const ChunkIndex& index, const Chunk& chunk) {
    const Chunk* const once = first_lap.chunks().find(index);
    ASSERT_NE(once, nullptr);
    const auto counts = chunk.toIncrements();
    const auto counts_once = once->toIncrements();
    ASSERT_EQ(counts.size(), counts_once.size());
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const std::uint64_t all = std::uint64_t{counts_once[i].count} * static_cast<unsigned>(laps);
      ASSERT_EQ(counts[i].count, std::min<std::uint64_t>(all, kMaxCount));
      saturated += all >= kMaxCount ? 1 : 0;
    }
  });
  EXPECT_EQ(map.at({0.1, 0.1, 0.1}).mostLikelyClass(), 3);
  // There a point counts for one: the lamp post has 1.2 million, and 2³² / 4096 is the limit.
  if (options.method == Method::SCsm && laps * kScansPerLap >= 20000) {
    EXPECT_GE(saturated, 1U);
  }
  const std::size_t tenth = times.size() / 10;
  std::printf("%d scans; insertion %.4f ms in the first tenth, %.4f ms in the last\n",
              laps * kScansPerLap, millisecondsOf(times, 0, tenth),
              millisecondsOf(times, times.size() - tenth, tenth));
}

INSTANTIATE_TEST_SUITE_P(Methods, Soak, testing::Values(Method::SCsm, Method::SurfaceCsom),
                         methodName);

}  // namespace
}  // namespace csom::test
