// SPDX-License-Identifier: BSD-3-Clause
// Order statistics of the stages of insertion.
#include "TimingSummary.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace csom {

namespace {

/// The smallest element that is not less than the share `q` of all (nearest rank).
double quantile(const std::vector<double>& sorted, double q) {
  const double rank = std::ceil(q * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

template <class Value>
StageTiming summarize(const char* key, const char* name, const std::vector<RunScan>& scans,
                      Value&& value) {
  std::vector<double> times;
  times.reserve(scans.size());
  for (const RunScan& scan : scans) times.push_back(value(scan));
  std::sort(times.begin(), times.end());
  return {key,
          name,
          std::accumulate(times.begin(), times.end(), 0.0),
          times.front(),
          quantile(times, 0.5),
          quantile(times, 0.95),
          times.back()};
}

}  // namespace

std::vector<StageTiming> summarizeTiming(const std::vector<RunScan>& scans) {
  if (scans.empty()) return {};
  return {
      summarize("insert", "whole insertion", scans, [](const RunScan& s) { return s.insert_ms; }),
      summarize("prepare", "rejecting, down-sampling, free space", scans,
                [](const RunScan& s) { return s.record.report.prepare_ms; }),
      summarize("infer", "kernel inference", scans,
                [](const RunScan& s) { return s.record.report.infer_ms; }),
      summarize("commit", "adding counts to the map", scans,
                [](const RunScan& s) { return s.record.report.commit_ms; }),
  };
}

}  // namespace csom
