// SPDX-License-Identifier: BSD-3-Clause
#include "image/ImageInference.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <tuple>
#include <utility>
#include <vector>

#include "image/DepthCube.h"
#include "image/FacetVotes.h"
#include "image/Facets.h"
#include "image/ImageBeams.h"
#include "image/ProjectiveFreeSpace.h"
#include "image/VoxelWords.h"
#include "inference/Counts.h"
#include "inference/FreeSpaceRays.h"
#include "util/Parallel.h"
#include "util/Parts.h"

namespace csom::detail {

namespace {

/// Everything that is known about a chunk: cells of the parts, and free voxels.
struct ChunkSource {
  std::uint64_t key;
  std::uint32_t part;  ///< kFreePart: `index` is that of free voxels
  std::uint32_t index;

  static constexpr std::uint32_t kFreePart = ~std::uint32_t{0};
  friend bool operator<(const ChunkSource& a, const ChunkSource& b) {
    return std::tie(a.key, a.part, a.index) < std::tie(b.key, b.part, b.index);
  }
};

class ImageInference {
 public:
  ImageInference(const PreparedScan& scan, const Options& options, ImageMemory& memory)
      : scan_(scan),
        options_(options),
        beams_(memory.beams),
        facets_(memory.facets),
        parts_(memory.parts),
        cube_(memory.cube) {}

  ScanIncrements run(ScanReport& report) {
    beams_.read(scan_, options_);
    facets_.find(beams_, options_);
    vote();
    findFree();
    const std::vector<ChunkSource> sources = sortedSources();
    std::vector<std::size_t> begin;
    for (std::size_t i = 0; i < sources.size(); ++i)
      if (i == 0 || sources[i].key != sources[i - 1].key) begin.push_back(i);
    begin.push_back(sources.size());
    ScanIncrements out(begin.size() - 1);
    std::atomic<std::size_t> occupied{0};
    std::atomic<std::size_t> free{0};
    parallelRanges(out.size(), options_.threads, [&](std::size_t first, std::size_t last) {
      Figures here;
      for (std::size_t i = first; i < last; ++i)
        out[i] = combine(sources.data() + begin[i], sources.data() + begin[i + 1], here);
      occupied += here.occupied;
      free += here.free;
    });
    report.voxels_updated += occupied;
    report.free_voxels += free;
    return out;
  }

 private:
  /// Of some chunks, one after the other.
  struct Figures {
    std::size_t occupied = 0;
    std::size_t free = 0;
    VoxelWord word;  ///< kept for its memory
  };

  /// Each part has words of its own: which part has what does not change their sum.
  void vote() {
    const std::size_t points = scan_.image_points.points.size();
    const std::size_t count = partsFor(points, options_.threads);
    parts_.resize(count);
    parallelRanges(count, options_.threads, [&](std::size_t first, std::size_t last) {
      for (std::size_t part = first; part < last; ++part) {
        parts_[part].clear();
        addHits(scan_, beams_, options_, partBegin(points, part, count),
                partBegin(points, part + 1, count), parts_[part]);
        addFacets(beams_, facets_, options_, partBegin(beams_.size(), part, count),
                  partBegin(beams_.size(), part + 1, count), parts_[part]);
      }
    });
  }

  void findFree() {
    ScanReport with_surfaces;  // not what the caller's report counts
    if (options_.free_space.mode == FreeSpace::Projective) {
      cube_.draw(beams_, facets_, options_);
      free_ = findFreeSpace(beams_, cube_, options_);
    }
    if (options_.free_space.mode == FreeSpace::Raycast)
      free_ = castFreeSpace(scan_, options_, toCount(options_.free_space.weight), with_surfaces);
  }

  /// As VoxelWords has it.
  std::uint64_t keyOf(const ChunkIndex& chunk) const {
    const ChunkIndex base = chunkOf(beams_.base);
    return chunkKey({chunk.x - base.x, chunk.y - base.y, chunk.z - base.z});
  }

  std::vector<ChunkSource> sortedSources() const {
    std::vector<ChunkSource> sources;
    for (std::size_t part = 0; part < parts_.size(); ++part)
      for (std::size_t i = 0; i < parts_[part].chunkCount(); ++i)
        sources.push_back({parts_[part].chunk(i).key, static_cast<std::uint32_t>(part),
                           static_cast<std::uint32_t>(i)});
    for (std::size_t i = 0; i < free_.size(); ++i)
      sources.push_back(
          {keyOf(free_[i].chunk), ChunkSource::kFreePart, static_cast<std::uint32_t>(i)});
    std::sort(sources.begin(), sources.end());
    return sources;
  }

  /// The increments of one chunk.
  ChunkIncrements combine(const ChunkSource* first, const ChunkSource* last,
                          Figures& figures) const {
    const ChunkIndex from_base = chunkOfKey(first->key);
    const ChunkIndex base = chunkOf(beams_.base);
    ChunkIncrements out{{base.x + from_base.x, base.y + from_base.y, base.z + from_base.z}, {}, {}};
    if (!isAddressable(out.chunk)) return out;
    const ChunkIncrements* free = nullptr;
    if ((last - 1)->part == ChunkSource::kFreePart) {
      free = &free_[(--last)->index];
      out.free = free->free;
    }
    if (first != last) appendWords(first, last, out, figures);
    std::size_t free_voxels = 0;
    for (const std::uint64_t bits : out.free.voxels)
      free_voxels += static_cast<std::size_t>(__builtin_popcountll(bits));
    if (free_voxels == 0) out.free.count = 0;
    if (free != nullptr) free_voxels += addWithoutSurface(free->increments, out.increments);
    figures.free += free_voxels;
    return out;
  }

  /// Adds those of voxels that have none yet, and tells how many they are. Both are sorted.
  static std::size_t addWithoutSurface(const std::vector<CountIncrement>& free,
                                       std::vector<CountIncrement>& increments) {
    if (free.empty()) return 0;
    std::vector<CountIncrement> all;
    all.reserve(free.size() + increments.size());
    const auto before = [](const CountIncrement& a, const CountIncrement& b) {
      return a.voxel < b.voxel;
    };
    std::size_t added = 0;
    auto next = increments.begin();
    for (const CountIncrement& increment : free) {
      const auto here = std::lower_bound(next, increments.end(), increment, before);
      all.insert(all.end(), next, here);
      next = here;
      if (here != increments.end() && here->voxel == increment.voxel) continue;
      all.push_back(increment);
      ++added;
    }
    all.insert(all.end(), next, increments.end());
    increments = std::move(all);
    return added;
  }

  /// Voxels with surface, which are therefore not free.
  void appendWords(const ChunkSource* first, const ChunkSource* last, ChunkIncrements& out,
                   Figures& figures) const {
    constexpr std::size_t kGroup = 8;
    VoxelWord& word = figures.word;
    for (std::size_t group = 0; group < kVoxelsPerChunk; group += kGroup) {
      VoxelWords::Cell any = 0;
      for (const ChunkSource* source = first; source != last; ++source)
        for (std::size_t i = 0; i < kGroup; ++i) any |= cellsOf(*source).cell[group + i];
      if (any == 0) continue;
      for (std::size_t voxel = group; voxel < group + kGroup; ++voxel) {
        word.clear();
        for (const ChunkSource* source = first; source != last; ++source)
          parts_[source->part].addTo(cellsOf(*source).cell[voxel], word);
        if (word.empty()) continue;
        word.appendTo(static_cast<std::uint16_t>(voxel), out.increments);
        out.free.voxels[voxel >> 6U] &= ~(std::uint64_t{1} << (voxel & 63U));
        ++figures.occupied;
      }
    }
  }
  const VoxelWords::Cells& cellsOf(const ChunkSource& source) const {
    return parts_[source.part].chunk(source.index);
  }

  const PreparedScan& scan_;
  const Options& options_;
  ImageBeams& beams_;
  Facets& facets_;
  std::vector<VoxelWords>& parts_;
  DepthCube& cube_;
  ScanIncrements free_;
};

}  // namespace

ScanIncrements inferFromImage(const PreparedScan& scan, const Options& options, ScanReport& report,
                              ImageMemory& memory) {
  return ImageInference(scan, options, memory).run(report);
}

}  // namespace csom::detail
