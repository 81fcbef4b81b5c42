// SPDX-License-Identifier: BSD-3-Clause
// Colours of classes.
#include "ClassColors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "Palette.h"

namespace csom {

namespace {

/// Okabe and Ito's, made to be told apart by colour-blind eyes.
constexpr std::array<Color, 7> kSafe{{{0, 114, 178},
                                      {230, 159, 0},
                                      {0, 158, 115},
                                      {204, 121, 167},
                                      {86, 180, 233},
                                      {213, 94, 0},
                                      {240, 228, 66}}};

/// The seven, then darker ones, then lighter ones: lightness is what everybody sees.
Color safeColor(std::size_t rank) {
  const Color color = kSafe[rank % kSafe.size()];
  const std::size_t round = rank / kSafe.size() % 3;
  const auto channel = [&](std::size_t i) {
    const double c = color[i];
    const double shade = round == 0 ? c : round == 1 ? 0.55 * c : c + 0.5 * (255 - c);
    return static_cast<std::uint8_t>(std::lround(shade));
  };
  return {channel(0), channel(1), channel(2)};
}

std::size_t classCount(const MapDocument& document) {
  return static_cast<std::size_t>(
      std::max(document.labels.numberOfClasses(), document.map.options().number_of_classes));
}

}  // namespace

std::vector<Color> labelColors(const MapDocument& document) {
  std::vector<Color> colors;
  for (std::size_t k = 0; k < classCount(document); ++k)
    colors.push_back(classOf(document.labels, static_cast<ClassId>(k)).color);
  return colors;
}

std::vector<Color> colorBlindSafeColors(const MapDocument& document) {
  std::vector<std::size_t> voxels(classCount(document), 0);
  document.map.forEachVoxel(
      [&](const VoxelIndex&, const DirichletVoxel& voxel) { ++voxels[voxel.mostLikelyClass()]; });
  std::vector<Color> colors(voxels.size(), kFreeSpace);
  std::vector<std::size_t> ranked(voxels.size() - 1);
  std::iota(ranked.begin(), ranked.end(), kFreeClass + 1);
  std::stable_sort(ranked.begin(), ranked.end(),
                   [&](std::size_t a, std::size_t b) { return voxels[a] > voxels[b]; });
  for (std::size_t rank = 0; rank < ranked.size(); ++rank) colors[ranked[rank]] = safeColor(rank);
  return colors;
}

}  // namespace csom
