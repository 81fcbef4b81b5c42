// SPDX-License-Identifier: BSD-3-Clause
// How a run keeps what it has done in a file while it goes on.
#pragma once

#include <csom/io/MapStore.h>

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>

namespace csom {

/// A run commits between two entries of a log: the voxels that have changed, the scans, and all
/// that it needs to go on, in one transaction. Whatever ends it, a run that is resumed makes the
/// map that it would have made, bit for bit.
struct CheckpointRequest {
  /// The map in work. It must not exist; with `resume` it must.
  std::string file;
  bool resume = false;
  /// Least time between two commits [s]; 0 = after every entry.
  double seconds = 10;
  /// Most memory for voxels [bytes], two thirds of it and at most 48 MB for the scan at hand: what
  /// is more is committed and dropped, and added up in the file. The process then gives memory that
  /// it frees back to the system at once.
  std::optional<std::size_t> max_memory;
  /// For the table `meta`, beside the inputs with their sizes and hashes.
  std::map<std::string, std::string> meta;
  /// The caller's own, for resuming: MapStore::State has them under `note.KEY`.
  std::map<std::string, std::string> notes;
  /// Called after every entry. True: commit, and end with Interrupted.
  std::function<bool()> stop;
  /// Called after every entry. A text, what is short: commit, and end with Error.
  std::function<std::optional<std::string>()> memory_shortage;
};

/// "112 MB are left of …" if the machine, the control group or the limits of the process leave less
/// than `reserve` bytes; nothing if there is enough or it cannot be told.
std::optional<std::string> memoryShortage(std::size_t reserve);

}  // namespace csom
