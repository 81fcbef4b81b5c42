// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/io/LabelSet.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "CodeFolder.h"

namespace csom {

namespace fs = std::filesystem;

namespace {

/// share/mrpt_csom/labels of every prefix that `folder` may belong to: PREFIX/bin, PREFIX/lib and
/// Debian's PREFIX/lib/TRIPLET.
std::vector<fs::path> shareFolders(fs::path folder) {
  std::vector<fs::path> result;
  for (int level = 0; level < 3 && !folder.empty(); ++level) {
    result.push_back(folder / "share/mrpt_csom/labels");
    if (folder == folder.parent_path()) break;
    folder = folder.parent_path();
  }
  return result;
}

std::vector<fs::path> candidates(const std::string& name_or_path, const std::string& base_folder) {
  std::vector<fs::path> result;
  if (!base_folder.empty()) result.push_back(fs::path(base_folder) / name_or_path);
  result.emplace_back(name_or_path);
  const std::string file_name = name_or_path + ".yaml";
  const bool bare_name = name_or_path.find('/') == std::string::npos;
  if (!bare_name) return result;
  if (const char* folders = std::getenv("CSOM_LABELS_PATH")) {
    std::istringstream list(folders);
    for (std::string folder; std::getline(list, folder, ':');) {
      if (!folder.empty()) result.push_back(fs::path(folder) / file_name);
    }
  }
  for (const fs::path& folder : shareFolders(detail::folderOfThisCode()))
    result.push_back(folder / file_name);
  return result;
}

}  // namespace

LabelSet LabelSet::occupancy() {
  LabelSet set;
  set.name_ = "occupancy";
  set.classes_ = {{0, "free", {255, 255, 255}}, {1, "occupied", {90, 110, 140}}};
  return set;
}

std::string LabelSet::find(const std::string& name_or_path, const std::string& base_folder) {
  if (name_or_path.empty())
    throw ConfigError("the name of the label set is empty; give a name or the path of a file");
  std::string looked;
  for (const fs::path& file : candidates(name_or_path, base_folder)) {
    std::error_code error;
    if (fs::is_regular_file(file, error)) return file.string();
    looked += (looked.empty() ? "" : ", ") + file.string();
  }
  throw ConfigError("label set '" + name_or_path + "' not found; looked for " + looked);
}

LabelSet::Raw LabelSet::classOfRaw(std::uint32_t raw_id) const {
  if (raw_.empty()) {
    if (raw_id >= classes_.size()) return {};
    return {RawKind::Class, static_cast<ClassId>(raw_id)};
  }
  const auto it = raw_.find(raw_id);
  return it == raw_.end() ? Raw{} : it->second;
}

std::optional<ClassId> LabelSet::classByName(const std::string& name) const {
  const auto it = std::find_if(classes_.begin(), classes_.end(),
                               [&](const LabelClass& c) { return c.name == name; });
  if (it == classes_.end()) return std::nullopt;
  return it->id;
}

std::optional<ClassId> LabelSet::classByColor(const Color& color) const {
  const auto it = std::find_if(classes_.begin(), classes_.end(), [&](const LabelClass& c) {
    return c.id != kFreeClass && c.color == color;
  });
  if (it == classes_.end()) return std::nullopt;
  return it->id;
}

LabelSet LabelSet::withUnlabelledClass() const {
  if (unlabelledClass() != kFreeClass) return *this;
  if (numberOfClasses() >= kMaxClasses)
    throw ConfigError("label set '" + name_ + "' has " + std::to_string(numberOfClasses()) +
                      " classes, so there is no room for one more, '" + kUnlabelledClass + "'");
  LabelSet extended = *this;
  Color gray{150, 150, 150};
  const auto taken = [&] {
    return std::any_of(classes_.begin(), classes_.end(),
                       [&](const LabelClass& c) { return c.color == gray; });
  };
  while (taken()) ++gray[2];
  const auto id = static_cast<ClassId>(numberOfClasses());
  if (raw_.empty()) {  // raw ids were class ids: they are so still, but the new one has none
    for (const LabelClass& c : classes_) extended.raw_[c.id] = {RawKind::Class, c.id};
  }
  extended.classes_.push_back({id, kUnlabelledClass, gray});
  return extended;
}

ClassId LabelSet::unlabelledClass() const {
  return classByName(kUnlabelledClass).value_or(kFreeClass);
}

}  // namespace csom
