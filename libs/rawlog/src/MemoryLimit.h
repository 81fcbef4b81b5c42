// SPDX-License-Identifier: BSD-3-Clause
// Keeps a damaged length field from bringing the machine down.
#pragma once

#include <sys/resource.h>

namespace csom::detail {

/// While it lives, the process cannot take more than the memory that is available now: an
/// allocation beyond it throws std::bad_alloc. MRPT allocates what a length in a file says before
/// it reads as much, and Linux grants such memory until the machine has none left.
class MemoryLimit {
 public:
  MemoryLimit();
  ~MemoryLimit();
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  rlimit before_{};
  bool active_ = false;
};

}  // namespace csom::detail
