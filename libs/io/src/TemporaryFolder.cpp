// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/io/TemporaryFolder.h>
#include <stdlib.h>

#include <system_error>

namespace csom {

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  const std::filesystem::path parent = std::filesystem::temp_directory_path(error);
  if (error) throw FileError("TMPDIR", "names no folder: " + error.message());
  std::string path = (parent / "csom-XXXXXX").string();
  if (mkdtemp(path.data()) == nullptr)
    throw FileError(path, "a temporary folder cannot be made there; set TMPDIR to another place");
  path_ = path;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace csom
