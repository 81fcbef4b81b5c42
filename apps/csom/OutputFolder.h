// SPDX-License-Identifier: BSD-3-Clause
// The folder that a command writes its results to.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace csom {

/// Created (with its parents) and tried out at once, so that hours of work cannot end at a folder
/// that cannot be written. Unless keep() is called, folders that were created are removed again.
class OutputFolder {
 public:
  /// Throws FileError.
  explicit OutputFolder(const std::string& path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::string path() const { return path_.string(); }
  void keep() { created_.clear(); }

 private:
  void removeCreated();

  std::filesystem::path path_;
  std::vector<std::filesystem::path> created_;  ///< outermost first
};

}  // namespace csom
