// SPDX-License-Identifier: BSD-3-Clause
// The floor under an insertion: read, transform, key and radix-sort the points, write as many count
// updates as the scan makes, and nothing else. Kept apart from the library's own code, so that
// whatever is made faster there is measured against the same floor.
#include <benchmark/benchmark.h>
#include <csom/core/SemanticMap.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "Benchmarks.h"
#include "MapOptions.h"
#include "Timing.h"

namespace csom::bench {

namespace {

/// Down-sampling cell and index of a point, in one word.
using Key = std::uint64_t;
constexpr int kAxisBits = 10;  // 1024 cells of 0.2 m: more than a scan's 160 m
constexpr int kIndexBits = 32;

void keyPoints(const SensorScan& scan, double cell, std::vector<Key>& keys) {
  const Eigen::Affine3d in_cells = Eigen::Scaling(1 / cell) * Eigen::Affine3d(scan.pose);
  const Eigen::Vector3d corner =
      scan.pose.translation() / cell - Eigen::Vector3d::Constant(1 << (kAxisBits - 1));
  keys.resize(scan.points.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Eigen::Vector3d p = in_cells * scan.points[i].cast<double>() - corner;
    const auto axis = [&p](int a) {
      return static_cast<Key>(static_cast<std::int64_t>(p[a])) & ((1U << kAxisBits) - 1);
    };
    const Key cell_key = (axis(2) << (2 * kAxisBits)) | (axis(1) << kAxisBits) | axis(0);
    keys[i] = (cell_key << kIndexBits) | i;
  }
}

void radixSort(std::vector<Key>& keys, std::vector<Key>& other) {
  constexpr int kDigits = 1 << kAxisBits;
  other.resize(keys.size());
  for (int shift = kIndexBits; shift < kIndexBits + 3 * kAxisBits; shift += kAxisBits) {
    std::array<std::uint32_t, kDigits> begin{};
    for (const Key key : keys) ++begin[(key >> shift) & (kDigits - 1)];
    std::uint32_t sum = 0;
    for (std::uint32_t& count : begin) sum += std::exchange(count, sum);
    for (const Key key : keys) other[begin[(key >> shift) & (kDigits - 1)]++] = key;
    keys.swap(other);
  }
}

/// Counts, one a voxel and class, that the scan adds to.
std::size_t countUpdates(const Scan& scan, const Options& options) {
  SemanticMap map(options);
  map.insert(scan);
  std::size_t updates = 0;
  map.forEachVoxel([&updates](const VoxelIndex&, const DirichletVoxel& voxel) {
    updates += static_cast<std::size_t>(voxel.size());
  });
  return updates;
}

}  // namespace

void registerFloor(const std::vector<SensorScan>& sensor_scans, const std::vector<Scan>& scans) {
  for (const Neighbourhood neighbourhood : {Neighbourhood::Radius, Neighbourhood::ExtendedBlock}) {
    const auto run = [&sensor_scans, &scans, neighbourhood](benchmark::State& state) {
      Options options = mapOptions();
      options.see_csom.neighbourhood = neighbourhood;
      std::vector<std::size_t> updates;
      for (const Scan& scan : scans) updates.push_back(countUpdates(scan, options));
      std::vector<std::uint32_t> counts(*std::max_element(updates.begin(), updates.end()));
      std::vector<Key> keys;
      std::vector<Key> other;
      timeInsertions(
          state, scans.size(), [] { return 0; },
          [&](int, std::size_t i) {
            keyPoints(sensor_scans[i], options.scan.ds_resolution, keys);
            radixSort(keys, other);
            benchmark::DoNotOptimize(keys.data());
            for (std::size_t update = 0; update < updates[i]; ++update) counts[update] += 1;
            benchmark::ClobberMemory();
          });
      state.counters["updates"] = median({updates.begin(), updates.end()});
    };
    benchmark::RegisterBenchmark(("floor/" + toString(neighbourhood)).c_str(), run)
        ->Unit(benchmark::kMillisecond)
        ->UseManualTime();
  }
}

}  // namespace csom::bench
