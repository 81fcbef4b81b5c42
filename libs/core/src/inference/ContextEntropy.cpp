// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/ContextEntropy.h>

#include <array>
#include <cmath>

#include "inference/BlockNeighbours.h"
#include "util/SortedKeys.h"

namespace csom {

double contextEntropy(const BlockContext& context, const Options& options) {
  const int neighbours = options.see_csom.context_neighbours;
  const int faces_missing = 6 - context.faces;
  const int edges_missing = neighbours >= 18 ? 12 - context.edges : 0;
  const int corners_missing = neighbours >= 26 ? 8 - context.corners : 0;
  const auto potential = [&](bool self, int faces, int edges, int corners) {
    return options.see_csom.context_weight_self * (self ? 1 : 0) +
           options.see_csom.context_weight_neighbour *
               (faces * std::exp(-0.5) + edges * std::exp(-1.0) + corners * std::exp(-1.5));
  };
  const double observed =
      potential(context.observed, context.faces, context.edges, context.corners);
  const double missing =
      potential(!context.observed, faces_missing, edges_missing, corners_missing);
  return 1.0 / (1.0 + std::exp(missing - observed));
}

namespace {

using detail::KeyPacking;

/// Whether a block of some context is filled. There are few contexts, so each is looked up after
/// its first time.
class ContextFilter {
 public:
  explicit ContextFilter(const Options& options)
      : options_(options), verdicts_(kContexts, Verdict::Unknown) {}

  bool fills(const BlockContext& context) {
    if (!options_.usesContextEntropy()) return true;
    Verdict& verdict = verdicts_[numberOf(context)];
    if (verdict == Verdict::Unknown)
      verdict = contextEntropy(context, options_) < options_.see_csom.context_threshold
                    ? Verdict::Empty
                    : Verdict::Filled;
    return verdict == Verdict::Filled;
  }

 private:
  enum class Verdict : std::uint8_t { Unknown, Filled, Empty };
  static constexpr std::size_t kContexts = 2 * 7 * 13 * 9;

  static std::size_t numberOf(const BlockContext& c) {
    return static_cast<std::size_t>((((c.observed ? 1 : 0) * 7 + c.faces) * 13 + c.edges) * 9 +
                                    c.corners);
  }

  const Options& options_;
  std::vector<Verdict> verdicts_;
};

/// Every observed block votes for all blocks of its extended block; the votes for a block are its
/// context. A vote is the position of the observed block and which kind of neighbour it is.
constexpr std::uint32_t kKindBits = 2;
constexpr std::uint32_t kKindMask = 3;

template <class Key>
std::vector<detail::KeyedItem<Key>> votesFor(const std::vector<BlockIndex>& observed_blocks,
                                             const KeyPacking& packing, const Options& options) {
  const std::vector<detail::BlockOffset> offsets =
      detail::extendedBlock(options.see_csom.context_neighbours);
  std::vector<detail::KeyedItem<Key>> votes(observed_blocks.size() * offsets.size());
  detail::parallelRanges(
      observed_blocks.size(), options.threads, [&](std::size_t begin, std::size_t end) {
        auto next = votes.begin() + static_cast<std::ptrdiff_t>(begin * offsets.size());
        for (std::size_t i = begin; i < end; ++i) {
          const BlockIndex& b = observed_blocks[i];
          for (const detail::BlockOffset& d : offsets)
            *next++ = {
                packing.pack<Key>({b.x + d.x, b.y + d.y, b.z + d.z}),
                static_cast<std::uint32_t>(i) << kKindBits | static_cast<std::uint32_t>(d.kind())};
        }
      });
  detail::stableSort(votes, packing.bits(), options.threads);
  return votes;
}

template <class Key>
std::vector<FilledBlock> filledBlocks(const std::vector<detail::KeyedItem<Key>>& votes,
                                      const KeyPacking& packing, const Options& options) {
  std::vector<FilledBlock> filled;
  ContextFilter filter(options);
  detail::forEachRun(votes, [&](std::size_t begin, std::size_t end) {
    std::array<int, 4> kinds{};
    FilledBlock block;
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t kind = votes[i].item & kKindMask;
      ++kinds[kind];
      if (kind == 0) block.observed = static_cast<std::int32_t>(votes[i].item >> kKindBits);
    }
    if (!filter.fills({kinds[0] > 0, kinds[1], kinds[2], kinds[3]})) return;
    const KeyPacking::Position p = packing.unpack(votes[begin].key);
    block.index = {static_cast<std::int32_t>(p[0]), static_cast<std::int32_t>(p[1]),
                   static_cast<std::int32_t>(p[2])};
    filled.push_back(block);
  });
  return filled;
}

}  // namespace

std::vector<FilledBlock> filledBlocks(const std::vector<BlockIndex>& observed_blocks,
                                      const Options& options) {
  KeyPacking packing;
  for (const BlockIndex& b : observed_blocks) packing.include({b.x, b.y, b.z});
  packing.finish(1);
  return detail::withKeyOf(packing, [&](auto key) {
    return filledBlocks(votesFor<decltype(key)>(observed_blocks, packing, options), packing,
                        options);
  });
}

}  // namespace csom
