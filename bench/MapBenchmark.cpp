// SPDX-License-Identifier: BSD-3-Clause
// Whole scans into a map, and questions to it. With CSOM_DATA set, SemanticKITTI scans take part.
#include <benchmark/benchmark.h>
#include <csom/core/SemanticMap.h>

#include <cstdlib>
#include <functional>
#include <memory>
#include <random>
#include <string>

#include "StreetScan.h"

namespace {

using csom::Options;
using csom::Scan;
using csom::SemanticMap;

Options streetOptions() {
  Options options;
  options.number_of_classes = 20;
  options.resolution = 0.3;
  options.ds_resolution = 0.2;
  return options;
}

void insertScans(benchmark::State& state, const std::vector<Scan>& scans, const Options& options) {
  csom::ScanReport sum;
  std::size_t inserted = 0;
  double bytes_per_voxel = 0;
  while (state.KeepRunningBatch(static_cast<benchmark::IterationCount>(scans.size()))) {
    SemanticMap map(options);
    for (const Scan& scan : scans) sum += map.insert(scan);
    inserted += scans.size();
    bytes_per_voxel =
        static_cast<double>(map.memoryBytes()) / static_cast<double>(map.knownVoxelCount());
  }
  const auto a_scan = [&](double total) { return total / static_cast<double>(inserted); };
  state.counters["points"] = a_scan(static_cast<double>(sum.points));
  state.counters["prepare_ms"] = a_scan(sum.prepare_ms);
  state.counters["infer_ms"] = a_scan(sum.infer_ms);
  state.counters["commit_ms"] = a_scan(sum.commit_ms);
  state.counters["bytes_per_voxel"] = bytes_per_voxel;
}

SemanticMap streetMap() {
  Options options = streetOptions();
  options.free_space = csom::FreeSpace::Raycast;
  SemanticMap map(options);
  map.insert(csom::bench::streetScan(1000));
  return map;
}

void copyMap(benchmark::State& state) {
  const SemanticMap map = streetMap();
  for (auto _ : state) {
    SemanticMap copy(map);
    benchmark::DoNotOptimize(copy);
  }
  state.counters["voxels"] = static_cast<double>(map.knownVoxelCount());
}

void askForPoints(benchmark::State& state) {
  const SemanticMap map = streetMap();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> x(-20, 20);
  std::uniform_real_distribution<double> z(0, 3);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 4096; ++i) points.emplace_back(x(random), x(random) / 2, z(random));
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(map.at(points[i++ % points.size()]).occupancy());
}

void castRays(benchmark::State& state) {
  const SemanticMap map = streetMap();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> component(-1, 1);
  double metres = 0;
  for (auto _ : state) {
    const Eigen::Vector3d direction(component(random), component(random), component(random) / 10);
    const auto hit = map.castRay({0, 0, 1.8}, direction, 50);
    metres += hit ? hit->distance : 50;
  }
  state.counters["voxels"] =
      benchmark::Counter(metres / map.grid().resolution(), benchmark::Counter::kIsRate);
}

void visitVoxels(benchmark::State& state) {
  const SemanticMap map = streetMap();
  for (auto _ : state) {
    std::size_t occupied = 0;
    map.forEachVoxel([&](const csom::VoxelIndex&, const csom::DirichletVoxel& voxel) {
      occupied += voxel.state() == csom::VoxelState::Occupied ? 1 : 0;
    });
    benchmark::DoNotOptimize(occupied);
  }
  state.counters["voxels"] = benchmark::Counter(static_cast<double>(map.knownVoxelCount()),
                                                benchmark::Counter::kIsIterationInvariantRate);
}

/// Scans are made when the first benchmark that wants them runs, and kept for the others.
using ScanMaker = std::function<std::vector<Scan>()>;

void registerInsertions(const std::string& name, const ScanMaker& make) {
  const auto scans = std::make_shared<std::vector<Scan>>();
  const auto add = [&](const std::string& variant, const Options& options) {
    const auto run = [scans, make, options](benchmark::State& state) {
      if (scans->empty()) *scans = make();
      insertScans(state, *scans, options);
    };
    benchmark::RegisterBenchmark(("insert/" + name + "/" + variant).c_str(), run)
        ->Unit(benchmark::kMillisecond);
  };
  for (const char* neighbourhood : {"radius", "extended-block"}) {
    Options options = streetOptions();
    csom::setOption(options, "neighbourhood", neighbourhood);
    add(neighbourhood, options);
  }
  for (const char* free_space : {"sampled", "raycast"}) {
    Options options = streetOptions();
    options.max_range = 50;
    csom::setOption(options, "free_space", free_space);
    add(std::string("free-") + free_space, options);
  }
}

}  // namespace

int main(int argc, char** argv) {
  registerInsertions("street-small",
                     [] { return std::vector<Scan>{csom::bench::streetScan(100)}; });
  registerInsertions("street", [] { return std::vector<Scan>{csom::bench::streetScan(2000)}; });
  if (const char* data = std::getenv("CSOM_DATA"))
    registerInsertions("semantickitti", [folder = std::string(data) + "/semantickitti_08"] {
      return csom::bench::semanticKittiScans(folder, 5);
    });
  benchmark::RegisterBenchmark("copy", copyMap)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("point-query", askForPoints);
  benchmark::RegisterBenchmark("cast-ray", castRays);
  benchmark::RegisterBenchmark("visit-voxels", visitVoxels)->Unit(benchmark::kMillisecond);

  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
