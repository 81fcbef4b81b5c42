// SPDX-License-Identifier: BSD-3-Clause
// Whether a map file is as it was written, and what can be saved of one that is not.
#pragma once

#include <csom/io/MapFile.h>

#include <cstddef>
#include <string>
#include <vector>

namespace csom {

struct MapVerification {
  std::size_t chunks = 0;  ///< intact ones
  std::size_t scans = 0;   ///< the same
  std::string digest;      ///< that of the intact chunks
  bool finished = true;    ///< false: the run that writes it has not come to its end
  /// What is wrong, a line each, at most kMaxFaults and one that counts the others. Empty: every
  /// byte of a finished file is as it was written.
  std::vector<std::string> faults;
  static constexpr std::size_t kMaxFaults = 20;
};

/// Reads the whole file a chunk at a time. Throws FileError only if there is no such file, or if it
/// is of a later version.
MapVerification verifyMap(const std::string& file);

struct MapRepair {
  MapDocument document;             ///< all that is intact
  std::vector<std::string> losses;  ///< what is not, a line each
  bool lost_chunks = false;
};

/// Finds every chunk and scan whose hash is right, wherever it lies in the file, even where the
/// database cannot be opened. Throws FileError if the file holds nothing of a map, or no longer
/// says what its chunks mean (the options, which are there twice).
MapRepair recoverMap(const std::string& file);

}  // namespace csom
