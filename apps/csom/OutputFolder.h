// SPDX-License-Identifier: BSD-3-Clause
// The folder that a command writes its results to.
#pragma once

#include <csom/core/TemporaryPath.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace csom {

/// Tried out at once, so that hours of work cannot end at a folder that cannot be written; what
/// that creates is removed again.
class OutputFolder {
 public:
  /// `results`: the names of all files that the command may write into it. Throws FileError if the
  /// folder cannot be created or written, or if a result has the name of a folder.
  OutputFolder(const std::string& path, const std::vector<std::string>& results);

  std::string file(const std::string& name) const { return (path_ / name).string(); }
  const std::filesystem::path& path() const { return path_; }
  const std::vector<std::string>& results() const { return results_; }

 private:
  std::filesystem::path path_;
  std::vector<std::string> results_;
};

/// Results on their way: written into a folder of their own inside the output folder, and moved to
/// their places together. If that never happens, they are removed; those of a process that was
/// killed by the next one that writes into the same folder.
class StagedResults {
 public:
  /// Creates the output folder with its parents. Throws FileError.
  explicit StagedResults(const OutputFolder& target);
  ~StagedResults();
  StagedResults(const StagedResults&) = delete;
  StagedResults& operator=(const StagedResults&) = delete;

  std::string path() const { return path_.string(); }
  std::string file(const std::string& name) const { return (path_ / name).string(); }

  /// Puts every result into place, and removes those of an earlier run that this one did not write.
  /// Throws FileError.
  void commit();

 private:
  const OutputFolder& target_;
  std::filesystem::path path_;
  std::vector<std::filesystem::path> created_;  ///< innermost first
  std::vector<std::unique_ptr<TemporaryPath>> temporary_;
};

}  // namespace csom
