// SPDX-License-Identifier: BSD-3-Clause
// One insertion of a fixed scan, whose instructions instructions.cmake counts.
// usage: core_InsertionInstructions [OPTION VALUE]…    options of the map, as in ini files
#include <csom/core/SemanticMap.h>

#include <cstdio>
#include <exception>
#include <random>

namespace {

/// Ground between two walls. The numbers come from integers, to be the same with any libm.
csom::Scan street() {
  std::mt19937 random(1);
  const auto uniform = [&random](float low, float high) {
    return low + (high - low) * (static_cast<float>(random() >> 8U) / (1U << 24U));
  };
  csom::Scan scan;
  scan.origin = {0.1, 0.2, 1.8};
  for (int i = 0; i < 20000; ++i) {
    const bool wall = i % 4 == 0;
    const float y = uniform(-8, 8);
    scan.points.emplace_back(uniform(-20, 20), wall ? (y < 0 ? -8.F : 8.F) : y,
                             wall ? uniform(-1.8F, 3) : -1.8F);
    scan.labels.push_back(static_cast<csom::ClassId>(wall ? 13 : y < -4 ? 11 : 9));
  }
  return scan;
}

}  // namespace

int main(int argc, char** argv) try {
  csom::Options options;
  options.number_of_classes = 20;
  options.resolution = 0.3;
  options.scan.ds_resolution = 0.2;
  for (int i = 1; i < argc; i += 2) {
    if (i + 1 == argc || !csom::setOption(options, argv[i], argv[i + 1])) {
      std::fprintf(stderr, "%s: no option of a map, or no value for it\n", argv[i]);
      return 1;
    }
  }
  csom::SemanticMap map(options);
  map.insert(street());
  std::printf("%zu known voxels\n", map.knownVoxelCount());
  return map.empty() ? 1 : 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
