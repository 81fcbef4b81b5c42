// SPDX-License-Identifier: BSD-3-Clause
// The tables of a map file, as docs/file-format.md describes them.
#pragma once

#include <csom/core/ScanReport.h>

#include <algorithm>
#include <cstdint>
#include <string>

namespace csom::detail {

/// "CSOM": what the program `file` and ourselves know a map by.
constexpr std::int64_t kApplicationId = 0x43534f4d;
/// To be raised with every change that an older reader would misunderstand.
constexpr std::int64_t kFormatVersion = 1;
/// The key of `meta` that holds mapDigest() of the map; it is the file's, not the document's.
constexpr const char* kDigestKey = "digest";

/// Calls `visitor(column, field)` for every count and time of a scan report. `Report` is
/// `ScanReport&` or `const ScanReport&`.
template <class Report, class Visitor>
void visitReportColumns(Report& report, Visitor&& visitor) {
  visitor("points", report.points);
  for (std::size_t i = 0; i < kRejectReasons; ++i) {
    std::string column = std::string("rejected_") + toString(static_cast<RejectReason>(i));
    std::replace(column.begin(), column.end(), '-', '_');
    visitor(column, report.rejected[i]);
  }
  visitor("training_points", report.training_points);
  visitor("free_points", report.free_points);
  visitor("free_voxels", report.free_voxels);
  visitor("blocks_observed", report.blocks_observed);
  visitor("blocks_filled", report.blocks_filled);
  visitor("voxels_updated", report.voxels_updated);
  visitor("prepare_ms", report.prepare_ms);
  visitor("infer_ms", report.infer_ms);
  visitor("commit_ms", report.commit_ms);
}

/// "timestamp, sensor_label, …": the columns of `scans` besides its key, in order.
std::string scanColumns();
/// The statements that make an empty map file.
std::string createTables();

}  // namespace csom::detail
