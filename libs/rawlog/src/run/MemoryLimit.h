// SPDX-License-Identifier: BSD-3-Clause
// Keeps a damaged length field from bringing the machine down.
#pragma once

#include <sys/resource.h>

#include <cstdint>

namespace csom::detail {

/// While it lives, the process cannot take more than `allowance` bytes in addition to what it has
/// now: an allocation beyond it throws std::bad_alloc. MRPT allocates and clears what a length in a
/// file says before it reads as much, and Linux grants such memory until the machine has none left.
/// The limit is the process's: other threads are bound by it too.
class MemoryLimit {
 public:
  explicit MemoryLimit(std::uint64_t allowance);
  ~MemoryLimit();
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  rlimit before_{};
  bool active_ = false;
};

}  // namespace csom::detail
