// SPDX-License-Identifier: BSD-3-Clause
// Sorts voxels into tiles and packs them.
#include "CubePacker.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <tuple>

namespace csom {

namespace {

using Index = std::array<std::int32_t, 3>;

constexpr int kTileBits = 5;
constexpr int kTileMask = (1 << kTileBits) - 1;
constexpr int kWordsPerTile = 1 << 2 * kTileBits;
constexpr std::size_t kLongestVector = 6;

/// Calls visit(VoxelIndex, DirichletVoxel) for every occupied voxel, chunk by chunk.
template <class Visitor>
void forEachOccupied(const SemanticMap& map, Visitor&& visit) {
  map.forEachVoxel([&](const VoxelIndex& index, const DirichletVoxel& voxel) {
    if (voxel.state() == VoxelState::Occupied) visit(index, voxel);
  });
}

VoxelIndex cubeOf(const VoxelIndex& v, int level) {
  return {v.x >> level, v.y >> level, v.z >> level};
}

/// How many cubes and tiles a map has at each level.
class LevelSizes {
 public:
  explicit LevelSizes(const SemanticMap& map) {
    std::array<std::bitset<kVoxelsPerChunk>, kCubeLevels> seen;
    std::optional<ChunkIndex> chunk;
    const auto countChunk = [&] {
      if (!chunk) return;
      for (std::size_t level = 0; level < kCubeLevels; ++level) {
        cubes_[level] += seen[level].count();
        const int shift = kTileBits - kChunkBits + static_cast<int>(level);
        tiles_[level].insert({chunk->x >> shift, chunk->y >> shift, chunk->z >> shift});
        seen[level].reset();
      }
    };
    forEachOccupied(map, [&](const VoxelIndex& index, const DirichletVoxel&) {
      if (chunk != chunkOf(index)) countChunk();
      chunk = chunkOf(index);
      for (int level = 0; level < kCubeLevels; ++level)
        seen[static_cast<std::size_t>(level)].set(
            static_cast<std::size_t>(indexInChunk(cubeOf(index, level))));
    });
    countChunk();
  }

  /// The finest level with at most so many cubes and tiles; else the coarsest.
  int fitting(std::size_t most_cubes, std::size_t most_tiles) const {
    int level = 0;
    const auto fits = [&](std::size_t l) {
      return cubes_[l] <= most_cubes && tiles_[l].size() <= most_tiles;
    };
    while (level < kCubeLevels - 1 && !fits(static_cast<std::size_t>(level))) ++level;
    return level;
  }

 private:
  std::array<std::size_t, kCubeLevels> cubes_{};
  std::array<std::set<Index>, kCubeLevels> tiles_;
};

std::uint8_t logarithmic(double value, std::pair<double, double> range) {
  const double decades = std::log(range.second / range.first);
  if (!(decades > 0)) return 255;
  const double share = std::log(std::max(value, range.first) / range.first) / decades;
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
}

}  // namespace

int cubeLevel(const SemanticMap& map, std::size_t most_cubes, std::size_t most_tiles) {
  return LevelSizes(map).fitting(most_cubes, most_tiles);
}

std::array<std::int32_t, 3> Cube::index() const {
  constexpr int kSide = 1 << kTileBits;
  return {tile[0] * kSide + (place & kTileMask), tile[1] * kSide + (place >> kTileBits & kTileMask),
          tile[2] * kSide + (place >> 2 * kTileBits)};
}

CubePacker::CubePacker(const SemanticMap& map, int level) {
  forEachOccupied(map, [&](const VoxelIndex& index, const DirichletVoxel& voxel) {
    add(cubeOf(index, level), voxel);
  });
  keepBestOfEachCube();
  evidence_ = rangeOf(&Cube::evidence);
  variance_ = rangeOf(&Cube::variance);
}

void CubePacker::add(const VoxelIndex& cube, const DirichletVoxel& voxel) {
  Cube added;
  added.tile = {cube.x >> kTileBits, cube.y >> kTileBits, cube.z >> kTileBits};
  added.place =
      static_cast<std::uint16_t>((cube.x & kTileMask) | (cube.y & kTileMask) << kTileBits |
                                 (cube.z & kTileMask) << 2 * kTileBits);
  const ClassId best = voxel.mostLikelyClass();
  added.evidence = static_cast<float>(voxel.evidence());
  added.variance = static_cast<float>(voxel.variance(best));
  added.vector_begin = static_cast<std::uint32_t>(classes_.size());
  addVector(voxel, best);
  added.vector_size = static_cast<std::uint8_t>(classes_.size() - added.vector_begin);
  cubes_.push_back(added);
}

void CubePacker::addVector(const DirichletVoxel& voxel, ClassId best) {
  const auto byteOf = [&](ClassId k) {
    return static_cast<std::uint8_t>(std::lround(255 * voxel.probability(k)));
  };
  vector_.clear();
  for (int i = 0; i < voxel.size(); ++i)
    if (voxel.classAt(i) != best) vector_.emplace_back(byteOf(voxel.classAt(i)), voxel.classAt(i));
  std::sort(vector_.begin(), vector_.end(), [](const auto& a, const auto& b) {
    return std::tie(b.first, a.second) < std::tie(a.first, b.second);
  });
  vector_.insert(vector_.begin(), {byteOf(best), best});
  vector_.resize(std::min(vector_.size(), kLongestVector));
  while (vector_.size() > 1 && vector_.back().first == 0) vector_.pop_back();
  for (const auto& [probability, k] : vector_) {
    classes_.push_back(static_cast<std::uint8_t>(k));
    probabilities_.push_back(probability);
  }
}

/// In the order of the page, and of the voxels of a cube the one of which most is known.
void CubePacker::keepBestOfEachCube() {
  std::sort(cubes_.begin(), cubes_.end(), [](const Cube& a, const Cube& b) {
    return std::tie(a.tile, a.place, b.evidence, a.vector_begin) <
           std::tie(b.tile, b.place, a.evidence, b.vector_begin);
  });
  const auto same = [](const Cube& a, const Cube& b) {
    return a.tile == b.tile && a.place == b.place;
  };
  cubes_.erase(std::unique(cubes_.begin(), cubes_.end(), same), cubes_.end());
  for (std::size_t i = 0; i < cubes_.size(); ++i) {
    if (startsTile(i)) ++tiles_;
    entries_ += cubes_[i].vector_size;
  }
}

bool CubePacker::startsTile(std::size_t i) const {
  return i == 0 || cubes_[i].tile != cubes_[i - 1].tile;
}

std::pair<double, double> CubePacker::rangeOf(float Cube::*field) const {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const Cube& cube : cubes_) {
    low = std::min(low, double(cube.*field));
    high = std::max(high, double(cube.*field));
  }
  if (!(high > 0)) return {1e-9, 1};
  // A logarithmic scale has no place for zero, nor is there anything to see over ten decades.
  return {std::max(low, high * 1e-6), high};
}

std::vector<std::uint8_t> CubePacker::pack() const {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(tiles_ * (12 + 4 * kWordsPerTile) + 3 * cubes_.size() + 2 * entries_);
  packTiles(bytes);
  for (const Cube& cube : cubes_) bytes.push_back(cube.vector_size);
  for (const Cube& cube : cubes_) bytes.push_back(logarithmic(cube.variance, variance_));
  for (const Cube& cube : cubes_) bytes.push_back(logarithmic(cube.evidence, evidence_));
  for (const auto* part : {&classes_, &probabilities_})
    for (const Cube& cube : cubes_)
      bytes.insert(bytes.end(), part->begin() + cube.vector_begin,
                   part->begin() + cube.vector_begin + cube.vector_size);
  return bytes;
}

void CubePacker::packTiles(std::vector<std::uint8_t>& bytes) const {
  const auto append = [&](std::uint32_t word) {
    for (int shift = 0; shift < 32; shift += 8)
      bytes.push_back(static_cast<std::uint8_t>(word >> shift));
  };
  for (std::size_t i = 0; i < cubes_.size(); ++i)
    if (startsTile(i))
      for (const std::int32_t index : cubes_[i].tile) append(static_cast<std::uint32_t>(index));
  for (std::size_t i = 0; i < cubes_.size();) {
    std::vector<std::uint32_t> words(kWordsPerTile, 0);
    do {
      words[cubes_[i].place >> kTileBits] |= 1u << (cubes_[i].place & 31);
      ++i;
    } while (i < cubes_.size() && !startsTile(i));
    for (const std::uint32_t word : words) append(word);
  }
}

}  // namespace csom
