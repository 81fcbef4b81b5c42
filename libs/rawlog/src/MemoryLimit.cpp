// SPDX-License-Identifier: BSD-3-Clause
// Keeps a damaged length field from bringing the machine down.
#include "MemoryLimit.h"

#include <unistd.h>

#include <cstdint>
#include <fstream>
#include <string>

namespace csom::detail {
namespace {

/// Bytes that this process can still take; 0 if the system does not say.
std::uint64_t availableMemory() {
  std::ifstream file("/proc/meminfo");
  std::string key, unit;
  std::uint64_t kilobytes = 0;
  while (file >> key >> kilobytes) {
    if (key == "MemAvailable:") return kilobytes * 1024;
    std::getline(file, unit);
  }
  return 0;
}

std::uint64_t ownAddressSpace() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t pages = 0;
  file >> pages;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

MemoryLimit::MemoryLimit() {
  const std::uint64_t available = availableMemory();
  if (available == 0 || getrlimit(RLIMIT_AS, &before_) != 0) return;
  rlimit limited = before_;
  limited.rlim_cur = static_cast<rlim_t>(ownAddressSpace() + available);
  if (limited.rlim_cur >= before_.rlim_cur) return;
  active_ = setrlimit(RLIMIT_AS, &limited) == 0;
}

MemoryLimit::~MemoryLimit() {
  if (active_) setrlimit(RLIMIT_AS, &before_);
}

}  // namespace csom::detail
