// SPDX-License-Identifier: BSD-3-Clause
// csom-bench-memory: what a process that maps a drive needs at its peak, above the same process
// before its first scan. A program of its own: a peak cannot be taken back.
// usage: csom-bench-memory [--quick]    scans as csom-bench takes them; prints JSON
#include <csom/core/SemanticMap.h>

#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>

#include "MapOptions.h"
#include "Scans.h"

namespace {

/// The process's peak of resident memory so far.
long peakKilobytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    long kilobytes = 0;
    if (word == "VmHWM:" && status >> kilobytes) return kilobytes;
  }
  throw std::runtime_error("/proc/self/status has no VmHWM");
}

}  // namespace

int main(int argc, char** argv) try {
  using namespace csom::bench;
  const Drive drive = chooseDrive(argc > 1 && std::string(argv[1]) == "--quick");
  const long idle = peakKilobytes();
  csom::SemanticMap map(mapOptions());
  for (std::size_t i = 0; i < drive.scans; ++i) map.insert(inMap(drive.scan(i)));
  std::printf(
      "{\"scans\": \"%s\", \"idle_kb\": %ld, \"peak_kb\": %ld, \"known_voxels\": %zu, "
      "\"map_bytes\": %zu}\n",
      drive.name.c_str(), idle, peakKilobytes(), map.knownVoxelCount(), map.memoryBytes());
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "csom-bench-memory: %s\n", error.what());
  return 1;
}
