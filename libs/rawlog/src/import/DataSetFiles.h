// SPDX-License-Identifier: BSD-3-Clause
// Finding and timing the files of a data set.
#pragma once

#include <csom/rawlog/Import.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace csom::detail {

constexpr double kScanPeriod = 0.1;  ///< [s], where a data set gives no times

/// A file of a data set that cannot be read must not be passed over: a link may be broken where a
/// disk is missing. Throws FileError.
void requireReadable(const std::filesystem::directory_entry& entry);

/// Positions chosen out of `files`. Throws FileError naming `folder` if there are none.
std::vector<std::size_t> choose(const ScanSelection& selection, const std::string& folder,
                                std::size_t count);

/// When the frames of a data set were taken, from a file of one time a line: either seconds
/// (times.txt of KITTI odometry) or "2011-09-26 13:02:25.96" (timestamps.txt of KITTI raw, taken as
/// UTC). Line i, counted from 0, is of frame i, also where other lines are blank. Without such a
/// file the frames are kScanPeriod apart, the first at 0.
class FrameTimes {
 public:
  /// Throws FileError if there is such a file but it cannot be read, naming the line.
  explicit FrameTimes(const std::string& file);

  bool areGiven() const { return times_.has_value(); }
  /// Time [s] of the frame of this number, which is in the file `scan`. Throws FileError if its
  /// line is blank or the file of times ends before: times of two origins in one log would not
  /// agree.
  double of(std::size_t number, const std::string& scan) const;

 private:
  std::string file_;
  std::optional<std::vector<std::optional<double>>> times_;
};

}  // namespace csom::detail
