// SPDX-License-Identifier: BSD-3-Clause
// Which map files another program has written.
#include "WrittenMaps.h"

namespace csom {

namespace fs = std::filesystem;

WrittenMaps::WrittenMaps(const std::vector<std::string>& prefixes) {
  places_.insert({".", ""});
  for (const std::string& prefix : prefixes) {
    fs::path path = fs::path(prefix).lexically_normal();
    if (path.has_parent_path() && !path.has_filename()) path = path.parent_path();  // "folder/"
    const std::string folder = path.parent_path().empty() ? "." : path.parent_path().string();
    if (!path.filename().empty()) places_.insert({folder, path.filename().string()});
  }
  before_ = find();
}

std::map<std::string, WrittenMaps::Stamp> WrittenMaps::find() const {
  std::map<std::string, Stamp> found;
  const auto add = [&](const fs::directory_entry& entry) {
    std::error_code error;
    if (entry.path().extension() != ".csom" || !entry.is_regular_file(error)) return;
    const Stamp stamp{entry.last_write_time(error), entry.file_size(error)};
    if (!error) found[entry.path().lexically_normal().string()] = stamp;
  };
  constexpr auto kSkip = fs::directory_options::skip_permission_denied;
  for (const auto& [folder, beginning] : places_) {
    std::error_code error;
    for (fs::directory_iterator entry(folder, kSkip, error), end; !error && entry != end;
         entry.increment(error)) {
      if (entry->path().filename().string().compare(0, beginning.size(), beginning) != 0) continue;
      add(*entry);
      if (beginning.empty() || !entry->is_directory(error)) continue;
      for (fs::recursive_directory_iterator inner(entry->path(), kSkip, error), last;
           !error && inner != last; inner.increment(error))
        add(*inner);
    }
  }
  return found;
}

std::vector<std::string> WrittenMaps::sinceThen() const {
  std::vector<std::string> files;
  for (const auto& [file, stamp] : find()) {
    const auto known = before_.find(file);
    if (known == before_.end() || known->second != stamp) files.push_back(file);
  }
  return files;
}

}  // namespace csom
