// SPDX-License-Identifier: BSD-3-Clause
// Finding and timing the files of a data set.
#pragma once

#include <csom/rawlog/Import.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace csom::detail {

constexpr double kScanPeriod = 0.1;  ///< [s], where a data set gives no times

/// Positions chosen out of `files`. Throws FileError naming `folder` if there are none.
std::vector<std::size_t> choose(const ScanSelection& selection, const std::string& folder,
                                std::size_t count);

/// The number that a file is named by ("000012.bin" → 12); nothing if its name is none.
std::optional<std::size_t> numberOfFile(const std::string& file);

/// When the scans of a data set were taken, from a file of one time a line: either seconds
/// (times.txt of KITTI odometry) or "2011-09-26 13:02:25.96" (timestamps.txt of KITTI raw, taken as
/// UTC). Without such a file the scans are kScanPeriod apart, the first at 0.
class ScanTimes {
 public:
  /// Throws FileError if there is such a file but it cannot be read, naming the line.
  explicit ScanTimes(const std::string& file);

  /// Time [s] of the scan of this number, which is in the file `scan`. Throws FileError if the file
  /// of times ends before: times of two origins in one log would not agree.
  double of(std::size_t number, const std::string& scan) const;

 private:
  std::string file_;
  std::optional<std::vector<double>> times_;
};

}  // namespace csom::detail
