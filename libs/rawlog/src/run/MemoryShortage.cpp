// SPDX-License-Identifier: BSD-3-Clause
// How much memory this process may still take.
#include <csom/rawlog/CheckpointRequest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <limits>

namespace csom {
namespace {

struct Room {
  std::uint64_t bytes = std::numeric_limits<std::uint64_t>::max();
  std::string of;
};

void narrow(Room& room, std::uint64_t bytes, const std::string& of) {
  if (bytes < room.bytes) room = {bytes, of};
}

std::uint64_t difference(std::uint64_t most, std::uint64_t used) {
  return most > used ? most - used : 0;
}

/// A number that stands alone in a file; nothing if there is none ("max").
std::optional<std::uint64_t> numberIn(const std::string& file) {
  std::ifstream stream(file);
  std::uint64_t number = 0;
  if (stream >> number) return number;
  return std::nullopt;
}

/// The field of a file with lines `NAME number`.
std::uint64_t fieldOf(const std::string& file, const std::string& name) {
  std::ifstream stream(file);
  std::string word, rest;
  std::uint64_t number = 0;
  while (stream >> word) {
    if (word == name && stream >> number) return number;
    std::getline(stream, rest);
  }
  return 0;
}

void machine(Room& room) {
  const std::string file = "/proc/meminfo";
  const std::uint64_t kilobytes = fieldOf(file, "MemAvailable:") + fieldOf(file, "SwapFree:");
  if (kilobytes > 0) narrow(room, kilobytes * 1024, "the machine's memory");
}

/// Control groups, version 2 and 1, as a container sees its own.
void controlGroup(Room& room) {
  const std::string base = "/sys/fs/cgroup/";
  for (const auto& [most, used, statistics, cache] :
       {std::array<std::string, 4>{"memory.max", "memory.current", "memory.stat", "inactive_file"},
        std::array<std::string, 4>{"memory/memory.limit_in_bytes", "memory/memory.usage_in_bytes",
                                   "memory/memory.stat", "total_inactive_file"}}) {
    const auto limit = numberIn(base + most);
    const auto current = numberIn(base + used);
    if (!limit || !current) continue;
    // What files left in memory is given back when it is needed.
    const std::uint64_t reclaimable = fieldOf(base + statistics, cache);
    narrow(room, difference(*limit, difference(*current, reclaimable)), "the control group's");
  }
}

void processLimit(Room& room) {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
  const std::uint64_t pages = numberIn("/proc/self/statm").value_or(0);
  const std::uint64_t used = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  narrow(room, difference(limit.rlim_cur, used), "the process's limit (ulimit -v)");
}

}  // namespace

std::optional<std::string> memoryShortage(std::size_t reserve) {
  Room room;
  machine(room);
  controlGroup(room);
  processLimit(room);
  if (room.bytes >= reserve) return std::nullopt;
  return std::to_string(room.bytes / 1000000) + " MB are left of " + room.of;
}

}  // namespace csom
