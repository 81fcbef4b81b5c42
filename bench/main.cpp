// SPDX-License-Identifier: BSD-3-Clause
// csom-bench: how fast the map is. docs/benchmarks.md explains each figure.
// usage: csom-bench [--quick] [OPTIONS OF GOOGLE BENCHMARK]
//   --quick   small scans of the simulated campus: to see that everything runs
// With CSOM_DATA set to the folder of the real data, SemanticKITTI scans; else the simulated
// campus.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <exception>
#include <limits>
#include <string>

#include "Benchmarks.h"

int main(int argc, char** argv) try {
  using namespace csom::bench;
  const bool quick = argc > 1 && std::string(argv[1]) == "--quick";
  if (quick) {
    argv[1] = argv[0];
    ++argv;
    --argc;
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;

  const Drive drive = chooseDrive(quick);
  std::vector<SensorScan> sensor_scans;
  for (std::size_t i = 0; i < drive.scans; ++i) sensor_scans.push_back(drive.scan(i));
  const std::vector<csom::Scan> scans = allInMap(drive);
  benchmark::AddCustomContext("scans", drive.name);

  registerInsertions(scans);
  registerOctoMap(scans);
  registerFloor(sensor_scans, scans);
  registerGrowth(scans, quick ? 10000 : std::numeric_limits<std::size_t>::max());
  registerQueries(scans);
  registerCopies(scans);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "csom-bench: %s\n", error.what());
  return 1;
}
