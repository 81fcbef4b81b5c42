// SPDX-License-Identifier: BSD-3-Clause
// The folder that a command writes its results to.
#include "OutputFolder.h"

#include <csom/core/Error.h>
#include <csom/io/OutputFile.h>
#include <csom/io/TextParser.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
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

constexpr char kStaging[] = "unfinished-";
constexpr char kNewMap[] = "unfinished.csom.tmp";

/// The number of the process that a name ends with; 0 if it does not begin with `prefix`.
int ownerOf(const std::string& name, const std::string& prefix) {
  if (name.rfind(prefix, 0) != 0) return 0;
  int owner = 0;
  return detail::parseNumber(std::string_view(name).substr(prefix.size()), owner) ? owner : 0;
}

/// A process that was killed could not do it itself.
void removeWhatTheDeadLeft(const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> abandoned;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    const int owner = std::max(ownerOf(name, kStaging), ownerOf(name, kNewMap));
    if (owner > 0 && ::kill(owner, 0) != 0 && errno == ESRCH) abandoned.push_back(entry.path());
  }
  for (const fs::path& path : abandoned) fs::remove_all(path, ignored);
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path, const std::vector<std::string>& results)
    : path_(path), results_(results) {
  const std::vector<fs::path> missing = missingFolders(path_);
  std::error_code ignored;
  fs::create_directories(path_, ignored);
  bool writable = true;
  try {
    OutputFile(file("writable"));
  } catch (const FileError&) {
    writable = false;
  }
  for (const fs::path& folder : missing) fs::remove(folder, ignored);
  if (!writable) throw FileError(path, "no file can be written in this folder");
  for (const std::string& name : results_) {
    if (fs::is_directory(path_ / name, ignored))
      throw FileError(file(name), "is a folder, but a result of that name is to be written");
  }
}

StagedResults::StagedResults(const OutputFolder& target)
    : target_(target), path_(target.path() / (kStaging + std::to_string(::getpid()))) {
  std::error_code error;
  fs::remove_all(path_, error);  // a dead process may have had our number
  created_ = missingFolders(path_);
  temporary_.push_back(std::make_unique<TemporaryPath>(path_.string()));
  for (const fs::path& folder : created_)
    temporary_.push_back(
        std::make_unique<TemporaryPath>(folder.string(), TemporaryPath::Kind::IfEmpty));
  fs::create_directories(path_, error);
  if (error) throw FileError(path_.string(), "cannot be created: " + error.message());
  removeWhatTheDeadLeft(target.path());
}

StagedResults::~StagedResults() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  // Those that hold results stay: only an empty folder can be removed.
  for (const fs::path& folder : created_) fs::remove(folder, ignored);
}

void StagedResults::commit() {
  for (const std::string& name : target_.results()) {
    std::error_code error;
    if (fs::exists(path_ / name, error)) {
      fs::rename(path_ / name, target_.path() / name, error);
    } else {
      fs::remove(target_.path() / name, error);
    }
    if (error) throw FileError(target_.file(name), "cannot be replaced: " + error.message());
  }
}

}  // namespace csom
