// SPDX-License-Identifier: BSD-3-Clause
// A file that appears complete or not at all.
#pragma once

#include <csom/core/TemporaryPath.h>

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace csom {

/// Writes to a temporary file in the folder of the target, which commit() flushes to the disk and
/// renames to the target. Without commit(), or after an error, the temporary file is removed and
/// whatever stood at the target before is untouched; so it is when a signal ends the process. A
/// symbolic link is followed.
///
/// A target that exists and is no regular file (a pipe, /dev/stdout) is written directly.
///
/// All members throw FileError that names the target. Not thread-safe.
class OutputFile {
 public:
  explicit OutputFile(const std::string& target);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Appends bytes (buffered).
  void write(const void* bytes, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }

  /// The file to fill, for libraries that open it by name. Do not mix with write().
  const std::string& path() const { return path_; }
  /// True if path() is the target itself, which is then no regular file.
  bool isDirect() const { return path_ == target_; }

  void commit();

 private:
  [[noreturn]] void fail(const char* action) const;
  void closeStream();

  std::string target_;  ///< links resolved
  std::string path_;
  std::unique_ptr<TemporaryPath> temporary_;  ///< null if written directly, or once committed
  std::FILE* stream_ = nullptr;
  bool committed_ = false;
};

}  // namespace csom
