// SPDX-License-Identifier: BSD-3-Clause
// Where this program lies, whose files are found from there.
#include "CodeFolder.h"

#include <dlfcn.h>

namespace csom::detail {

namespace fs = std::filesystem;

fs::path folderOfThisCode() {
  Dl_info info{};
  std::error_code error;
  if (::dladdr(reinterpret_cast<const void*>(&folderOfThisCode), &info) != 0 &&
      info.dli_fname != nullptr) {
    // For a program dli_fname is argv[0], which need not name a file: then /proc knows.
    const fs::path file = fs::canonical(info.dli_fname, error);
    if (!error) return file.parent_path();
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path() : program.parent_path();
}

}  // namespace csom::detail
