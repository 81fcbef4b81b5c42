// SPDX-License-Identifier: BSD-3-Clause
// What became of the points of a scan.
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace csom {

/// Why a point was not used.
enum class RejectReason {
  NonFinite,          ///< NaN or infinite coordinates
  TooNear,            ///< nearer than min_range
  TooFar,             ///< farther than max_range
  ClassOutOfRange,    ///< class id ≥ number_of_classes
  InvalidScores,      ///< soft labels negative, non-finite or not summing to 1 ± 1e-3
  OutsideIndexRange,  ///< beyond what voxel indices can address
  BeamTooLong,        ///< free space along it would take more than 8192 steps
};
constexpr std::size_t kRejectReasons = 7;

/// "non-finite", "too-near", … as used in reports.
const char* toString(RejectReason reason);

/// Counts and stage timings of one insertion. Sums of reports are reports.
struct ScanReport {
  std::size_t points = 0;                              ///< as given
  std::array<std::size_t, kRejectReasons> rejected{};  ///< by RejectReason
  std::size_t training_points = 0;                     ///< hits left after down-sampling
  std::size_t free_points = 0;                         ///< free samples left after down-sampling
  std::size_t free_voxels = 0;  ///< voxels that beams make free (raycast, projective)
  std::size_t blocks_observed = 0;
  std::size_t blocks_filled = 0;   ///< blocks with f_J = 1
  std::size_t voxels_updated = 0;  ///< voxels that received kernel mass
  double prepare_ms = 0;           ///< reject, down-sample, free space, bin
  double infer_ms = 0;             ///< entropies and kernels
  double commit_ms = 0;            ///< adding the counts to the map

  std::size_t rejectedTotal() const;
  ScanReport& operator+=(const ScanReport& other);
};

/// "rejected_too_near", …: the name of a count of `rejected` where names have no hyphens.
std::string rejectedName(RejectReason reason);

/// Calls `visitor(name, field_of_each…)` for every count and time of one or several reports, each a
/// `ScanReport&` or `const ScanReport&`. Whatever reads, writes or adds reports goes through here.
template <class Visitor, class... Reports>
void visitReports(Visitor&& visitor, Reports&... reports) {
  visitor("points", reports.points...);
  for (std::size_t i = 0; i < kRejectReasons; ++i)
    visitor(rejectedName(static_cast<RejectReason>(i)), reports.rejected[i]...);
  visitor("training_points", reports.training_points...);
  visitor("free_points", reports.free_points...);
  visitor("free_voxels", reports.free_voxels...);
  visitor("blocks_observed", reports.blocks_observed...);
  visitor("blocks_filled", reports.blocks_filled...);
  visitor("voxels_updated", reports.voxels_updated...);
  visitor("prepare_ms", reports.prepare_ms...);
  visitor("infer_ms", reports.infer_ms...);
  visitor("commit_ms", reports.commit_ms...);
}

/// Calls `visitor(name, field)` for every count (std::size_t) and time (double) of a report.
template <class Report, class Visitor>
void visitReport(Report& report, Visitor&& visitor) {
  visitReports(visitor, report);
}

}  // namespace csom
