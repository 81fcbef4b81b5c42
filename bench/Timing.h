// SPDX-License-Identifier: BSD-3-Clause
// Times of single insertions, of which Google Benchmark alone would only keep the mean.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

namespace csom::bench {

inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Times insert(map, i) for i = 0 … scans − 1 into what makeMap() returns, over and over. The
/// counter `median_ms` is the median of single insertions.
template <class MakeMap, class Insert>
void timeInsertions(benchmark::State& state, std::size_t scans, MakeMap&& makeMap,
                    Insert&& insert) {
  std::vector<double> seconds;
  while (state.KeepRunningBatch(static_cast<benchmark::IterationCount>(scans))) {
    auto map = makeMap();
    for (std::size_t i = 0; i < scans; ++i) {
      const auto start = std::chrono::steady_clock::now();
      insert(map, i);
      const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
      seconds.push_back(elapsed.count());
      state.SetIterationTime(elapsed.count());
    }
  }
  state.counters["median_ms"] = 1e3 * median(std::move(seconds));
}

}  // namespace csom::bench
