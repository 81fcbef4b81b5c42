// SPDX-License-Identifier: BSD-3-Clause
// The folder that a command writes its results to.
#pragma once

#include <filesystem>
#include <string>

namespace csom {

/// Tried out at once, so that hours of work cannot end at a folder that cannot be written; what
/// that creates is removed again, so that a run that fails or is killed leaves nothing behind.
class OutputFolder {
 public:
  /// Throws FileError if the folder cannot be created or written.
  explicit OutputFolder(const std::string& path);

  /// Creates the folder with its parents. Throws FileError.
  void create() const;

  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace csom
