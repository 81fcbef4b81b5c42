// SPDX-License-Identifier: BSD-3-Clause
// What all importers of data sets share.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace csom {

/// Which scans of a data set, counted from 0 in the order of their files.
struct ScanSelection {
  std::size_t first = 0;
  std::optional<std::size_t> end;  ///< one past the last; nothing: to the end
  std::size_t every = 1;           ///< takes first, first + every, …

  /// "a:b" as in Python, without negative numbers: a … b−1; either may be left out. Throws
  /// ConfigError.
  static ScanSelection parse(const std::string& range, std::size_t every);

  /// Positions out of 0 … count−1.
  std::vector<std::size_t> positions(std::size_t count) const;
};

struct ImportSummary {
  std::size_t scans = 0;
  std::size_t points = 0;
  std::size_t images = 0;
  std::string labels;                 ///< where those of the points come from, in plain words
  std::vector<std::string> options;   ///< that could change that, see Error::options()
  std::vector<std::string> warnings;  ///< one line each
};

/// Called after every scan.
using ImportProgress = std::function<void(std::size_t scans_done, std::size_t scans)>;

/// "2.pcd" before "10.pcd": runs of digits are compared as numbers.
bool naturalLess(const std::string& a, const std::string& b);

namespace detail {

/// Files of `folder` that end in `extension` (".bin"), in any case, in natural order. Throws
/// FileError if there is no such folder or no such file in it, or if one of them is no file (a
/// broken link).
std::vector<std::string> filesIn(const std::string& folder, const std::string& extension);

/// The numbers that files are named by ("000012.bin" → 12): files of one frame have one number, and
/// its times and poses are in the lines of that number. Throws FileError about the first file whose
/// name is no number, or is that of another one ("12.bin" and "012.bin").
std::vector<std::size_t> numbersOfFiles(const std::vector<std::string>& files);

}  // namespace detail
}  // namespace csom
