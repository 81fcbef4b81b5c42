// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/io/TemporaryFolder.h>
#include <stdlib.h>

#include <system_error>

namespace csom {

TemporaryFolder::TemporaryFolder() {
  std::string path = (std::filesystem::temp_directory_path() / "csom-XXXXXX").string();
  if (mkdtemp(path.data()) == nullptr)
    throw FileError(path, "a temporary folder cannot be made there; set TMPDIR to another place");
  path_ = path;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace csom
