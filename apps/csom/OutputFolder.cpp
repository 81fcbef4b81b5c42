// SPDX-License-Identifier: BSD-3-Clause
// The folder that a command writes its results to.
#include "OutputFolder.h"

#include <csom/core/Error.h>
#include <csom/io/OutputFile.h>

#include <vector>

namespace csom {

namespace fs = std::filesystem;

namespace {

/// The folder and those above it that do not exist yet, innermost first.
std::vector<fs::path> missingFolders(const fs::path& path) {
  std::vector<fs::path> missing;
  fs::path folder = fs::absolute(path).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  std::error_code error;
  for (; !fs::exists(folder, error) && folder.has_relative_path(); folder = folder.parent_path())
    missing.push_back(folder);
  if (!fs::is_directory(folder, error))
    throw FileError(path.string(), "cannot be a folder: " + folder.string() + " is a file");
  return missing;
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path) : path_(path) {
  const std::vector<fs::path> missing = missingFolders(path_);
  create();
  bool writable = true;
  try {
    OutputFile(file("writable"));
  } catch (const FileError&) {
    writable = false;
  }
  std::error_code ignored;
  for (const fs::path& folder : missing) fs::remove(folder, ignored);
  if (!writable) throw FileError(path, "no file can be written in this folder");
}

void OutputFolder::create() const {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) throw FileError(path_.string(), "cannot be created: " + error.message());
}

}  // namespace csom
