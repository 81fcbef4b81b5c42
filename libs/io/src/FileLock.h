// SPDX-License-Identifier: BSD-3-Clause
// Keeps a file for one process.
#pragma once

#include <string>

namespace csom::detail {

/// Held as long as this lives; the system gives it up with the process, however that ends. Readers
/// do not ask for it. It does not get in the way of SQLite's own locks, which are of another kind,
/// as long as this outlives the connection: closing a file gives up all of those.
class FileLock {
 public:
  /// Opens `path` and locks it. Throws FileError, about `shown_name`, if it is not there or another
  /// process has it.
  FileLock(const std::string& path, const std::string& shown_name);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  /// Flushes the file to the disk.
  bool sync() const;

 private:
  int descriptor_;
};

}  // namespace csom::detail
