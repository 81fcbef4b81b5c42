// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/ScanReport.h>

#include <algorithm>
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

std::string rejectedName(RejectReason reason) {
  std::string name = std::string("rejected_") + toString(reason);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

std::size_t ScanReport::rejectedTotal() const {
  return std::accumulate(rejected.begin(), rejected.end(), std::size_t{0});
}

ScanReport& ScanReport::operator+=(const ScanReport& other) {
  visitReports([](const std::string&, auto& sum, const auto& addend) { sum += addend; }, *this,
               other);
  return *this;
}

}  // namespace csom
