// SPDX-License-Identifier: BSD-3-Clause
// Keeps a damaged length field from bringing the machine down.
#include "run/MemoryLimit.h"

#include <unistd.h>

#include <cstdint>
#include <fstream>

namespace csom::detail {
namespace {

std::uint64_t ownAddressSpace() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t pages = 0;
  file >> pages;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

MemoryLimit::MemoryLimit(std::uint64_t allowance) {
  if (getrlimit(RLIMIT_AS, &before_) != 0) return;
  rlimit limited = before_;
  limited.rlim_cur = static_cast<rlim_t>(ownAddressSpace() + allowance);
  if (limited.rlim_cur >= before_.rlim_cur) return;
  active_ = setrlimit(RLIMIT_AS, &limited) == 0;
}

MemoryLimit::~MemoryLimit() {
  if (active_) setrlimit(RLIMIT_AS, &before_);
}

}  // namespace csom::detail
