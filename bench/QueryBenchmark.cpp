// SPDX-License-Identifier: BSD-3-Clause
#include <benchmark/benchmark.h>
#include <csom/core/SemanticMap.h>

#include <cstdlib>
#include <random>
#include <vector>

#include "Benchmarks.h"
#include "MapOptions.h"

namespace csom::bench {

namespace {

constexpr double kRange = 50;  // [m]

/// A map with free space, which rays go through.
SemanticMap mapToAsk(const std::vector<Scan>& scans) {
  Options options = mapOptions();
  options.free_space.mode = FreeSpace::Raycast;
  options.scan.max_range = kRange;
  SemanticMap map(options);
  for (const Scan& scan : scans) map.insert(scan);
  return map;
}

/// Centres of known voxels, picked at random: few enough to be asked for again and again while they
/// are in the cache.
void askForPoints(benchmark::State& state, const std::vector<Scan>& scans) {
  const SemanticMap map = mapToAsk(scans);
  std::vector<Eigen::Vector3d> centers;
  map.forEachVoxel(
      [&](const VoxelIndex& v, const DirichletVoxel&) { centers.push_back(map.grid().center(v)); });
  std::mt19937 random(1);
  constexpr std::size_t kPoints = 4096;
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < kPoints; ++i) points.push_back(centers[random() % centers.size()]);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(map.at(points[i++ % kPoints]).occupancy());
}

std::size_t voxelsBetween(const VoxelIndex& a, const VoxelIndex& b) {
  return static_cast<std::size_t>(std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.z - b.z) +
                                  1);
}

void castRays(benchmark::State& state, const std::vector<Scan>& scans) {
  const SemanticMap map = mapToAsk(scans);
  const Eigen::Vector3d origin = scans.front().origin;
  const VoxelIndex start = map.grid().voxelAt(origin);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> component(-1, 1);
  std::size_t voxels = 0;
  for (auto _ : state) {
    const Eigen::Vector3d direction =
        Eigen::Vector3d(component(random), component(random), component(random) / 5).normalized();
    const auto hit = map.castRay(origin, direction, kRange);
    voxels +=
        voxelsBetween(start, hit ? hit->voxel : map.grid().voxelAt(origin + kRange * direction));
  }
  state.counters["voxels_per_second"] =
      benchmark::Counter(static_cast<double>(voxels), benchmark::Counter::kIsRate);
}

void visitVoxels(benchmark::State& state, const std::vector<Scan>& scans) {
  const SemanticMap map = mapToAsk(scans);
  for (auto _ : state) {
    std::size_t occupied = 0;
    map.forEachVoxel([&](const VoxelIndex&, const DirichletVoxel& voxel) {
      occupied += voxel.state() == VoxelState::Occupied ? 1 : 0;
    });
    benchmark::DoNotOptimize(occupied);
  }
  state.counters["voxels_per_second"] = benchmark::Counter(
      static_cast<double>(map.knownVoxelCount()), benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace

void registerQueries(const std::vector<Scan>& scans) {
  const auto add = [&scans](const char* name, auto ask) {
    return benchmark::RegisterBenchmark(
        name, [ask, &scans](benchmark::State& state) { ask(state, scans); });
  };
  add("query/point", askForPoints);
  add("query/ray", castRays)->Unit(benchmark::kMicrosecond);
  add("query/visit", visitVoxels)->Unit(benchmark::kMillisecond);
}

}  // namespace csom::bench
