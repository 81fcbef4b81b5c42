// SPDX-License-Identifier: BSD-3-Clause
// What 3-D views show of a map.
#include <csom/core/EnumWords.h>
#include <csom/maps/RenderingOptions.h>

namespace csom {
namespace {

constexpr detail::EnumWords<VoxelColor, 3> kColors{{{VoxelColor::Class, "class"},
                                                    {VoxelColor::Probability, "probability"},
                                                    {VoxelColor::Height, "height"}}};

}  // namespace

std::string toString(VoxelColor value) {
  return detail::wordOf(kColors, value);
}

void parse(const std::string& key, const std::string& text, VoxelColor& value) {
  detail::parseWord(kColors, key, text, value);
}

}  // namespace csom
