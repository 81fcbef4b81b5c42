// SPDX-License-Identifier: BSD-3-Clause
// Which map files another program has written.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace csom {

/// Map files in places where programs of MRPT leave them, as they were at the beginning and as they
/// are later.
class WrittenMaps {
 public:
  /// The working folder itself, and for each prefix `FOLDER/NAME` the entries of FOLDER whose names
  /// begin with NAME: files, and folders with all that is in them.
  explicit WrittenMaps(const std::vector<std::string>& prefixes);

  /// Files that are new or changed since then, in order.
  std::vector<std::string> sinceThen() const;

 private:
  using Stamp = std::pair<std::filesystem::file_time_type, std::uintmax_t>;
  std::map<std::string, Stamp> find() const;

  std::set<std::pair<std::string, std::string>> places_;  ///< folder, beginning of the name
  std::map<std::string, Stamp> before_;
};

}  // namespace csom
