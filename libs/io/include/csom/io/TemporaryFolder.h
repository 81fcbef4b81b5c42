// SPDX-License-Identifier: BSD-3-Clause
// A folder of its own that goes when it is left.
#pragma once

#include <csom/core/TemporaryPath.h>

#include <filesystem>
#include <memory>
#include <string>

namespace csom {

/// Under TMPDIR, else /tmp; removed with all that is in it, also if a signal ends the process.
class TemporaryFolder {
 public:
  /// Throws FileError.
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
  std::unique_ptr<TemporaryPath> temporary_;
};

}  // namespace csom
