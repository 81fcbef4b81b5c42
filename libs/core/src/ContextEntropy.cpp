// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/ContextEntropy.h>

#include <cmath>

#include "BlockNeighbours.h"
#include "SortedKeys.h"

namespace csom {

double contextEntropy(const BlockContext& context, const Options& options) {
  const int neighbours = options.context_neighbours;
  const int faces_missing = 6 - context.faces;
  const int edges_missing = neighbours >= 18 ? 12 - context.edges : 0;
  const int corners_missing = neighbours >= 26 ? 8 - context.corners : 0;
  const auto potential = [&](bool self, int faces, int edges, int corners) {
    return options.context_weight_self * (self ? 1 : 0) +
           options.context_weight_neighbour *
               (faces * std::exp(-0.5) + edges * std::exp(-1.0) + corners * std::exp(-1.5));
  };
  const double observed =
      potential(context.observed, context.faces, context.edges, context.corners);
  const double missing =
      potential(!context.observed, faces_missing, edges_missing, corners_missing);
  return 1.0 / (1.0 + std::exp(missing - observed));
}

std::vector<FilledBlock> filledBlocks(const std::vector<BlockIndex>& observed_blocks,
                                      const Options& options) {
  using detail::KeyPacking;
  constexpr std::uint32_t kKindBits = 2;
  constexpr std::uint32_t kKindMask = 3;

  KeyPacking packing;
  for (const BlockIndex& b : observed_blocks) packing.include({b.x, b.y, b.z});
  packing.finish(1);
  // Every observed block announces itself to its extended block; what a block hears is its context.
  const std::vector<detail::BlockOffset> offsets =
      detail::extendedBlock(options.context_neighbours);
  std::vector<detail::KeyedItem<std::uint64_t>> heard;
  heard.reserve(observed_blocks.size() * offsets.size());
  for (std::size_t i = 0; i < observed_blocks.size(); ++i) {
    const BlockIndex& b = observed_blocks[i];
    for (const detail::BlockOffset& d : offsets)
      heard.push_back(
          {packing.pack({b.x + d.x, b.y + d.y, b.z + d.z}),
           static_cast<std::uint32_t>(i) << kKindBits | static_cast<std::uint32_t>(d.kind())});
  }
  detail::stableSort(heard, packing.bits());

  std::vector<FilledBlock> filled;
  detail::forEachRun(heard, [&](std::size_t begin, std::size_t end) {
    BlockContext context;
    FilledBlock block;
    for (std::size_t i = begin; i < end; ++i) {
      switch (heard[i].item & kKindMask) {
        case 0:
          context.observed = true;
          block.observed = static_cast<std::int32_t>(heard[i].item >> kKindBits);
          break;
        case 1:
          ++context.faces;
          break;
        case 2:
          ++context.edges;
          break;
        default:
          ++context.corners;
          break;
      }
    }
    if (options.usesContextEntropy() &&
        contextEntropy(context, options) < options.context_threshold)
      return;
    const KeyPacking::Position p = packing.unpack(heard[begin].key);
    block.index = {static_cast<std::int32_t>(p[0]), static_cast<std::int32_t>(p[1]),
                   static_cast<std::int32_t>(p[2])};
    filled.push_back(block);
  });
  return filled;
}

}  // namespace csom
