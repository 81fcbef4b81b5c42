// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/ScanReport.h>

#include <numeric>

namespace csom {

const char* toString(RejectReason reason) {
  switch (reason) {
    case RejectReason::NonFinite:
      return "non-finite";
    case RejectReason::TooNear:
      return "too-near";
    case RejectReason::TooFar:
      return "too-far";
    case RejectReason::ClassOutOfRange:
      return "class-out-of-range";
    case RejectReason::InvalidScores:
      return "invalid-scores";
    case RejectReason::OutsideIndexRange:
      return "outside-index-range";
    case RejectReason::BeamTooLong:
      return "beam-too-long";
  }
  return "invalid";
}

std::size_t ScanReport::rejectedTotal() const {
  return std::accumulate(rejected.begin(), rejected.end(), std::size_t{0});
}

ScanReport& ScanReport::operator+=(const ScanReport& other) {
  points += other.points;
  for (std::size_t i = 0; i < rejected.size(); ++i) rejected[i] += other.rejected[i];
  training_points += other.training_points;
  free_points += other.free_points;
  free_voxels += other.free_voxels;
  blocks_observed += other.blocks_observed;
  blocks_filled += other.blocks_filled;
  voxels_updated += other.voxels_updated;
  prepare_ms += other.prepare_ms;
  infer_ms += other.infer_ms;
  commit_ms += other.commit_ms;
  return *this;
}

}  // namespace csom
