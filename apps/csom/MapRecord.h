// SPDX-License-Identifier: BSD-3-Clause
// What a run of csom map leaves to its report.
#pragma once

#include <csom/rawlog/MappingRun.h>
#include <csom/report/RunRecord.h>

namespace csom {

/// `seconds`: wall time of the run.
RunRecord makeRecord(const MappingRequest& request, const MappingResult& result, double seconds);

}  // namespace csom
