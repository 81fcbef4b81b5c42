// SPDX-License-Identifier: BSD-3-Clause
// The folder that a command writes its results to.
#include "OutputFolder.h"

#include <csom/core/Error.h>
#include <csom/io/OutputFile.h>

namespace csom {

namespace fs = std::filesystem;

OutputFolder::OutputFolder(const std::string& path) : path_(path) {
  std::error_code error;
  fs::path missing = fs::absolute(path_).lexically_normal();
  if (!missing.has_filename()) missing = missing.parent_path();
  std::vector<fs::path> to_create;
  for (; !fs::exists(missing, error) && missing.has_relative_path();
       missing = missing.parent_path())
    to_create.insert(to_create.begin(), missing);
  if (fs::exists(missing, error) && !fs::is_directory(missing, error))
    throw FileError(path, "cannot be a folder: " + missing.string() + " is a file");
  for (const fs::path& folder : to_create) {
    if (fs::create_directory(folder, error)) created_.push_back(folder);
    if (!error) continue;
    removeCreated();
    throw FileError(path, "cannot be created: " + error.message());
  }
  try {
    OutputFile(file("writable"));
  } catch (const FileError&) {
    removeCreated();
    throw FileError(path, "no file can be written in this folder");
  }
}

OutputFolder::~OutputFolder() {
  removeCreated();
}

void OutputFolder::removeCreated() {
  std::error_code ignored;
  for (auto folder = created_.rbegin(); folder != created_.rend(); ++folder)
    fs::remove(*folder, ignored);
  created_.clear();
}

}  // namespace csom
