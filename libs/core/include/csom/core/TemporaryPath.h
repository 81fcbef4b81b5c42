// SPDX-License-Identifier: BSD-3-Clause
// Files and folders that a process must not leave behind, however it ends.
#pragma once

#include <string>

namespace csom {

/// Names a file or folder that is about to be made and is worth nothing unless it is finished. As
/// long as this lives, removeTemporaryPaths() removes it: to be constructed before the file is
/// made, and destroyed when the file has its final name or is gone. Does not remove anything
/// itself. Thread-safe.
class TemporaryPath {
 public:
  enum class Kind {
    Whole,   ///< a file with what libraries write beside it, or a folder with all that it holds
    IfEmpty  ///< a folder that goes only if it is empty
  };
  explicit TemporaryPath(std::string path, Kind kind = Kind::Whole);
  ~TemporaryPath();
  TemporaryPath(const TemporaryPath&) = delete;
  TemporaryPath& operator=(const TemporaryPath&) = delete;

 private:
  std::string path_;
};

/// For a process that is about to end by a signal: removes all that is named by a TemporaryPath.
/// From then on, constructing and destroying one blocks, so that nothing new appears while the
/// process ends. Not to be called in a signal handler, but by a thread of its own. Does not throw.
void removeTemporaryPaths() noexcept;

}  // namespace csom
