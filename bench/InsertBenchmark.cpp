// SPDX-License-Identifier: BSD-3-Clause
#include <benchmark/benchmark.h>
#include <csom/core/SemanticMap.h>

#include <string>
#include <vector>

#include "Benchmarks.h"
#include "MapOptions.h"
#include "Timing.h"

namespace csom::bench {

namespace {

void insertScans(benchmark::State& state, const std::vector<Scan>& scans, const Options& options) {
  std::vector<double> points;
  std::vector<double> prepare;
  std::vector<double> infer;
  std::vector<double> commit;
  double bytes_per_voxel = 0;
  const auto insert = [&](SemanticMap& map, std::size_t i) {
    const ScanReport report = map.insert(scans[i]);
    points.push_back(static_cast<double>(report.points));
    prepare.push_back(report.prepare_ms);
    infer.push_back(report.infer_ms);
    commit.push_back(report.commit_ms);
  };
  timeInsertions(
      state, scans.size(), [&] { return SemanticMap(options); }, insert);
  SemanticMap map(options);
  for (const Scan& scan : scans) map.insert(scan);
  bytes_per_voxel =
      static_cast<double>(map.memoryBytes()) / static_cast<double>(map.knownVoxelCount());
  state.counters["points"] = median(points);
  state.counters["prepare_ms"] = median(prepare);
  state.counters["infer_ms"] = median(infer);
  state.counters["commit_ms"] = median(commit);
  state.counters["known_voxels"] = static_cast<double>(map.knownVoxelCount());
  state.counters["bytes_per_voxel"] = bytes_per_voxel;
}

void add(const std::string& name, const std::vector<Scan>& scans, const Options& options) {
  benchmark::RegisterBenchmark(
      name.c_str(),
      [&scans, options](benchmark::State& state) { insertScans(state, scans, options); })
      ->Unit(benchmark::kMillisecond)
      ->UseManualTime();
}

}  // namespace

void registerInsertions(const std::vector<Scan>& scans) {
  for (const Neighbourhood neighbourhood : {Neighbourhood::Radius, Neighbourhood::ExtendedBlock}) {
    const std::string name = "insert/" + toString(neighbourhood);
    Options options = mapOptions();
    options.see_csom.neighbourhood = neighbourhood;
    add(name, scans, options);
    Options two_threads = options;
    two_threads.threads = 2;
    add(name + "/two-threads", scans, two_threads);
    Options fine = options;
    fine.resolution = fine.scan.ds_resolution = 0.1;
    add(name + "/fine", scans, fine);
  }
  for (const FreeSpace free_space : {FreeSpace::None, FreeSpace::Projective}) {
    Options options = mapOptions();
    options.method = Options{}.method;
    options.free_space.mode = free_space;
    if (free_space != FreeSpace::None) options.scan.max_range = 50;
    const std::string name = "insert/default/" + toString(free_space);
    add(name, scans, options);
    options.threads = 2;
    add(name + "/two-threads", scans, options);
  }
  for (const FreeSpace free_space : {FreeSpace::None, FreeSpace::Sampled, FreeSpace::Raycast}) {
    Options options = mapOptions();
    options.scan.max_range = 50;
    options.free_space.mode = free_space;
    add("insert/free-space/" + toString(free_space), scans, options);
  }
}

}  // namespace csom::bench
