// SPDX-License-Identifier: BSD-3-Clause
// Where the time of a run's insertions went.
#pragma once

#include <csom/report/RunRecord.h>

#include <vector>

namespace csom {

/// One stage of an insertion over all scans [ms].
struct StageTiming {
  const char* key;   ///< "insert", "prepare", "infer", "commit"
  const char* name;  ///< in words
  double total = 0;
  double min = 0;
  double median = 0;
  double p95 = 0;  ///< 95 % of the scans took at most this
  double max = 0;
};

/// The whole insertion first, then its stages. Nothing if there are no scans.
std::vector<StageTiming> summarizeTiming(const std::vector<RunScan>& scans);

}  // namespace csom
