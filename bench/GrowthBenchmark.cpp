// SPDX-License-Identifier: BSD-3-Clause
#include <benchmark/benchmark.h>
#include <csom/core/SemanticMap.h>

#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "Benchmarks.h"
#include "MapOptions.h"
#include "Timing.h"

namespace csom::bench {

namespace {

void add(const std::string& name, const std::function<Scan()>& makeScan) {
  const auto run = [makeScan](benchmark::State& state) {
    const Scan scan = makeScan();
    timeInsertions(
        state, 1, [] { return SemanticMap(mapOptions()); },
        [&scan](SemanticMap& map, std::size_t) { map.insert(scan); });
    state.counters["points"] = static_cast<double>(scan.points.size());
  };
  benchmark::RegisterBenchmark(name.c_str(), run)->Unit(benchmark::kMillisecond)->UseManualTime();
}

}  // namespace

void registerGrowth(const std::vector<Scan>& scans, std::size_t most_points) {
  const std::size_t seen =
      std::accumulate(scans.begin(), scans.end(), std::size_t{0},
                      [](std::size_t sum, const Scan& scan) { return sum + scan.points.size(); });
  for (const std::size_t points : {1000U, 3000U, 10000U, 30000U, 100000U, 300000U, 1000000U}) {
    if (points > most_points) break;
    const std::string number = std::to_string(points);
    add("points/wider/" + number, [&scans, points] { return widerScene(scans.front(), points); });
    if (points <= seen)
      add("points/denser/" + number, [&scans, points] { return denserScene(scans, points); });
  }
}

}  // namespace csom::bench
