// SPDX-License-Identifier: BSD-3-Clause
// One insertion of a fixed scan, whose instructions instructions.cmake counts.
// usage: core_InsertionInstructions [image] [OPTION VALUE]…    options of the map, as in ini files
#include <csom/core/SemanticMap.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
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

/// The same street as a sensor of 32 rows sees it from its middle. Without sines: its beams go
/// through the sides of a square.
csom::Scan streetAsImage() {
  constexpr int kRows = 32;
  constexpr int kColumns = 1200;
  csom::Scan scan;
  scan.origin = {0.1, 0.2, 1.8};
  scan.image.columns_of_turn = kColumns;
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const int side = 4 * column / kColumns;
      const float along = static_cast<float>(column % (kColumns / 4)) / (kColumns / 8) - 1;
      const float x = side == 0 ? along : side == 1 ? 1.F : side == 2 ? -along : -1.F;
      const float y = side == 0 ? -1.F : side == 1 ? along : side == 2 ? 1.F : -along;
      const float z = 0.015F * static_cast<float>(row) - 0.4F;
      float range = 20 / std::max(std::abs(x), 1e-3F);
      range = std::min(range, 8 / std::max(std::abs(y), 1e-3F));
      const bool ground = z < 0 && -1.8F / z < range;
      if (ground) range = -1.8F / z;
      scan.points.emplace_back(range * x, range * y, range * z);
      scan.labels.push_back(static_cast<csom::ClassId>(!ground ? 13 : range * y < -4 ? 11 : 9));
      scan.image.pixels.push_back({static_cast<std::uint16_t>(row), column});
    }
  return scan;
}

}  // namespace

int main(int argc, char** argv) try {
  csom::Options options;
  options.number_of_classes = 20;
  options.resolution = 0.3;
  options.scan.ds_resolution = 0.2;
  const bool image = argc > 1 && std::strcmp(argv[1], "image") == 0;
  for (int i = image ? 2 : 1; i < argc; i += 2) {
    if (i + 1 == argc || !csom::setOption(options, argv[i], argv[i + 1])) {
      std::fprintf(stderr, "%s: no option of a map, or no value for it\n", argv[i]);
      return 1;
    }
  }
  csom::SemanticMap map(options);
  map.insert(image ? streetAsImage() : street());
  std::printf("%zu known voxels\n", map.knownVoxelCount());
  return map.empty() ? 1 : 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
