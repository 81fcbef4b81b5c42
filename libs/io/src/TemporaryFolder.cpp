// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/io/TemporaryFolder.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

namespace csom {

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  const std::filesystem::path parent = std::filesystem::temp_directory_path(error);
  if (error) throw FileError("TMPDIR", "names no folder: " + error.message());
  for (int attempt = 0;; ++attempt) {
    path_ = parent / ("csom-" + std::to_string(::getpid()) + "-" + std::to_string(attempt));
    temporary_ = std::make_unique<TemporaryPath>(path_.string());
    if (::mkdir(path_.c_str(), S_IRWXU) == 0) return;
    if (errno != EEXIST)
      throw FileError(path_.string(),
                      "a temporary folder cannot be made there; set TMPDIR to another place");
  }
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace csom
