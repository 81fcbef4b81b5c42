// SPDX-License-Identifier: BSD-3-Clause
#include <benchmark/benchmark.h>
#include <octomap/octomap.h>

#include <memory>
#include <vector>

#include "Benchmarks.h"
#include "MapOptions.h"
#include "Timing.h"

namespace csom::bench {

namespace {

octomap::Pointcloud makeCloud(const Scan& scan) {
  const Eigen::Vector3f origin = scan.origin.cast<float>();
  octomap::Pointcloud cloud;
  for (const Eigen::Vector3f& point : scan.points) {
    const Eigen::Vector3f p = origin + point;
    cloud.push_back(p.x(), p.y(), p.z());
  }
  return cloud;
}

}  // namespace

void registerOctoMap(const std::vector<Scan>& scans) {
  const auto run = [&scans](benchmark::State& state) {
    std::vector<octomap::Pointcloud> clouds;
    for (const Scan& scan : scans) clouds.push_back(makeCloud(scan));
    timeInsertions(
        state, scans.size(),
        [] { return std::make_unique<octomap::OcTree>(mapOptions().resolution); },
        [&](const std::unique_ptr<octomap::OcTree>& tree, std::size_t i) {
          const Eigen::Vector3f origin = scans[i].origin.cast<float>();
          constexpr double kNoMaxRange = -1;
          constexpr bool kLazy = false;
          constexpr bool kDiscretise = true;
          tree->insertPointCloud(clouds[i], {origin.x(), origin.y(), origin.z()}, kNoMaxRange,
                                 kLazy, kDiscretise);
        });
  };
  benchmark::RegisterBenchmark("octomap", run)->Unit(benchmark::kMillisecond)->UseManualTime();
}

}  // namespace csom::bench
