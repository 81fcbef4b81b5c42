// SPDX-License-Identifier: BSD-3-Clause
// Files and folders that a process must not leave behind, however it ends.
#include <csom/core/TemporaryPath.h>

#include <unistd.h>
#include <chrono>
#include <filesystem>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace csom {
namespace {

namespace fs = std::filesystem;

struct Registry {
  std::mutex mutex;
  std::multimap<std::string, TemporaryPath::Kind> paths;
};

/// A signal is a matter of the whole process, and so is what it has to leave tidy. Never destroyed:
/// a signal may come while the process ends.
Registry& registry() {
  static auto* const instance = new Registry;
  return *instance;
}

/// A file and what libraries have made beside it under its name: journals, temporary files of
/// theirs.
std::vector<fs::path> withCompanions(const fs::path& path) {
  std::vector<fs::path> found{path};
  std::error_code error;
  const std::string start = path.filename().string();
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    const bool is_companion = name.size() > start.size() &&
                              name.compare(0, start.size(), start) == 0 &&
                              (name[start.size()] == '.' || name[start.size()] == '-');
    if (is_companion) found.push_back(at->path());
  }
  return found;
}

void removeWhole(const fs::path& path) {
  // Other threads are still running and may just be adding to a folder.
  constexpr int kTries = 50;
  for (int i = 0; i < kTries; ++i) {
    bool gone = true;
    for (const fs::path& one : withCompanions(path)) {
      std::error_code error;
      fs::remove_all(one, error);
      gone = gone && !error;
    }
    if (gone) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

}  // namespace

TemporaryPath::TemporaryPath(std::string path, Kind kind) : path_(std::move(path)) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path_, error);
  if (!error) path_ = absolute.string();
  const std::lock_guard lock(registry().mutex);
  registry().paths.emplace(path_, kind);
}

TemporaryPath::~TemporaryPath() {
  const std::lock_guard lock(registry().mutex);
  const auto found = registry().paths.find(path_);
  if (found != registry().paths.end()) registry().paths.erase(found);
}

void removeTemporaryPaths() noexcept {
  registry().mutex.lock();  // for good
  try {
    for (const auto& [path, kind] : registry().paths)
      if (kind == TemporaryPath::Kind::Whole) removeWhole(path);
    // The innermost first.
    for (auto path = registry().paths.rbegin(); path != registry().paths.rend(); ++path)
      if (path->second == TemporaryPath::Kind::IfEmpty) ::rmdir(path->first.c_str());
  } catch (const std::exception&) {
    // What cannot be removed stays.
  }
}

}  // namespace csom
