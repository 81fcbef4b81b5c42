// SPDX-License-Identifier: BSD-3-Clause
// Packs voxels for the viewer of the page.
#include "ViewerModel.h"

#include <csom/report/MapPicture.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "ClassColors.h"
#include "Palette.h"
#include "Trajectories.h"
#include "ViewAxes.h"

namespace csom {

namespace {

using Json = nlohmann::ordered_json;
using Index = std::array<std::int32_t, 3>;

constexpr int kTileBits = 5;
constexpr int kWordsPerTile = 1 << 2 * kTileBits;
constexpr int kLevels = kChunkBits + 1;  ///< a cube is a part of a chunk
constexpr std::size_t kLongestVector = 6;
/// A tile costs the browser some kilobytes, however empty it is.
constexpr std::size_t kMostTiles = 15'000;

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
    std::array<std::bitset<kVoxelsPerChunk>, kLevels> seen;
    std::optional<ChunkIndex> chunk;
    const auto countChunk = [&] {
      if (!chunk) return;
      for (std::size_t level = 0; level < kLevels; ++level) {
        cubes_[level] += seen[level].count();
        const int shift = kTileBits - kChunkBits + static_cast<int>(level);
        tiles_[level].insert({chunk->x >> shift, chunk->y >> shift, chunk->z >> shift});
        seen[level].reset();
      }
    };
    forEachOccupied(map, [&](const VoxelIndex& index, const DirichletVoxel&) {
      if (chunk != chunkOf(index)) countChunk();
      chunk = chunkOf(index);
      for (int level = 0; level < kLevels; ++level)
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
    while (level < kLevels - 1 && !fits(static_cast<std::size_t>(level))) ++level;
    return level;
  }

 private:
  std::array<std::size_t, kLevels> cubes_{};
  std::array<std::set<Index>, kLevels> tiles_;
};

struct Cube {
  Index tile{};
  std::uint16_t place = 0;  ///< x + 32·y + 1024·z in the tile
  float evidence = 0;
  float variance = 0;
  std::uint8_t vector_size = 0;
  std::uint32_t vector_begin = 0;
};

class CubePacker {
 public:
  CubePacker(const MapDocument& document, int level) : level_(level) {
    forEachOccupied(document.map, [&](const VoxelIndex& index, const DirichletVoxel& voxel) {
      add(cubeOf(index, level_), voxel);
    });
    keepBestOfEachCube();
    findRanges();
  }

  const std::vector<Cube>& cubes() const { return cubes_; }
  std::size_t tileCount() const { return tiles_; }
  std::size_t entryCount() const { return entries_; }
  std::pair<double, double> evidence() const { return evidence_; }
  std::pair<double, double> variance() const { return variance_; }
  ClassId classOf(const Cube& cube) const { return classes_[cube.vector_begin]; }

  std::vector<std::uint8_t> pack() const {
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

 private:
  void add(const VoxelIndex& cube, const DirichletVoxel& voxel) {
    constexpr int kMask = (1 << kTileBits) - 1;
    Cube added;
    added.tile = {cube.x >> kTileBits, cube.y >> kTileBits, cube.z >> kTileBits};
    added.place = static_cast<std::uint16_t>((cube.x & kMask) | (cube.y & kMask) << kTileBits |
                                             (cube.z & kMask) << 2 * kTileBits);
    const ClassId best = voxel.mostLikelyClass();
    added.evidence = static_cast<float>(voxel.evidence());
    added.variance = static_cast<float>(voxel.variance(best));
    added.vector_begin = static_cast<std::uint32_t>(classes_.size());
    addVector(voxel, best);
    added.vector_size = static_cast<std::uint8_t>(classes_.size() - added.vector_begin);
    cubes_.push_back(added);
  }

  void addVector(const DirichletVoxel& voxel, ClassId best) {
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
  void keepBestOfEachCube() {
    std::sort(cubes_.begin(), cubes_.end(), [](const Cube& a, const Cube& b) {
      return std::tie(a.tile, a.place, b.evidence, a.vector_begin) <
             std::tie(b.tile, b.place, a.evidence, b.vector_begin);
    });
    const auto same = [](const Cube& a, const Cube& b) {
      return a.tile == b.tile && a.place == b.place;
    };
    cubes_.erase(std::unique(cubes_.begin(), cubes_.end(), same), cubes_.end());
    for (std::size_t i = 0; i < cubes_.size(); ++i) {
      if (i == 0 || cubes_[i].tile != cubes_[i - 1].tile) ++tiles_;
      entries_ += cubes_[i].vector_size;
    }
  }

  void findRanges() {
    const auto range = [&](float Cube::*field) -> std::pair<double, double> {
      double low = std::numeric_limits<double>::infinity(), high = 0;
      for (const Cube& cube : cubes_) {
        low = std::min(low, double(cube.*field));
        high = std::max(high, double(cube.*field));
      }
      if (!(high > 0)) return {1e-9, 1};
      // A logarithmic scale has no place for zero, nor is there anything to see over ten decades.
      return {std::max(low, high * 1e-6), high};
    };
    evidence_ = range(&Cube::evidence);
    variance_ = range(&Cube::variance);
  }

  static std::uint8_t logarithmic(double value, std::pair<double, double> range) {
    const double decades = std::log(range.second / range.first);
    if (!(decades > 0)) return 255;
    const double share = std::log(std::max(value, range.first) / range.first) / decades;
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
  }

  void packTiles(std::vector<std::uint8_t>& bytes) const {
    const auto append = [&](std::uint32_t word) {
      for (int shift = 0; shift < 32; shift += 8)
        bytes.push_back(static_cast<std::uint8_t>(word >> shift));
    };
    const auto startsTile = [&](std::size_t i) {
      return i == 0 || cubes_[i].tile != cubes_[i - 1].tile;
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

  int level_;
  std::vector<Cube> cubes_;
  std::vector<std::uint8_t> classes_;
  std::vector<std::uint8_t> probabilities_;
  std::vector<std::pair<std::uint8_t, ClassId>> vector_;  ///< scratch
  std::size_t tiles_ = 0;
  std::size_t entries_ = 0;
  std::pair<double, double> evidence_;
  std::pair<double, double> variance_;
};

Index placeOf(const Cube& cube) {
  constexpr int kMask = (1 << kTileBits) - 1;
  return {cube.tile[0] << kTileBits | (cube.place & kMask),
          cube.tile[1] << kTileBits | (cube.place >> kTileBits & kMask),
          cube.tile[2] << kTileBits | cube.place >> 2 * kTileBits};
}

/// The box without the outermost cubes, which may be far away.
Json focusOf(const std::vector<Cube>& cubes) {
  Json low = Json::array(), high = Json::array();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<std::int32_t> places;
    places.reserve(cubes.size());
    for (const Cube& cube : cubes) places.push_back(placeOf(cube)[axis]);
    std::sort(places.begin(), places.end());
    const std::size_t margin = places.size() / 200;
    low.push_back(places[margin]);
    high.push_back(places[places.size() - 1 - margin] + 1);
  }
  return {{"low", low}, {"high", high}};
}

Json layersOf(const std::vector<Cube>& cubes, const SignedAxis& up) {
  std::int32_t low = std::numeric_limits<std::int32_t>::max(), high = -low;
  for (const Cube& cube : cubes) {
    const Index place = placeOf(cube);
    const std::int32_t layer = up.along(VoxelIndex{place[0], place[1], place[2]});
    low = std::min(low, layer);
    high = std::max(high, layer);
  }
  return {{"low", low}, {"high", high}};
}

Json classesOf(const CubePacker& packer, const LabelSet& labels) {
  std::array<std::size_t, kMaxClasses> counts{};
  for (const Cube& cube : packer.cubes()) ++counts[packer.classOf(cube)];
  std::vector<ClassId> present;
  for (std::size_t k = 0; k < counts.size(); ++k)
    if (counts[k] > 0) present.push_back(static_cast<ClassId>(k));
  std::stable_sort(present.begin(), present.end(),
                   [&](ClassId a, ClassId b) { return counts[a] > counts[b]; });
  Json classes = Json::array();
  for (const ClassId k : present) {
    const LabelClass label = classOf(labels, k);
    const auto& hidden = MapPictureOptions().hidden_classes;
    const bool shown = std::find(hidden.begin(), hidden.end(), label.name) == hidden.end();
    classes.push_back(
        {{"id", k}, {"name", label.name}, {"voxels", counts[k]}, {"shown", shown}});
  }
  return classes;
}

Json classNamesOf(const MapDocument& document) {
  const std::vector<Color> colors = labelColors(document), safe = colorBlindSafeColors(document);
  Json names = Json::array();
  for (std::size_t k = 0; k < colors.size(); ++k)
    names.push_back({{"name", classOf(document.labels, static_cast<ClassId>(k)).name},
                     {"color", colors[k]},
                     {"safeColor", safe[k]}});
  return names;
}

Json trajectoriesOf(const RunRecord& record, double cube_edge) {
  Json trajectories = Json::array();
  for (const std::vector<Eigen::Vector3d>& places : trajectories3d(record)) {
    Json points = Json::array();
    for (const Eigen::Vector3d& p : places) {
      Json point = Json::array();
      for (int axis = 0; axis < 3; ++axis)
        point.push_back(std::round(p[axis] / cube_edge * 100) / 100);
      points.push_back(point);
    }
    trajectories.push_back(points);
  }
  return trajectories;
}

Json rangeJson(std::pair<double, double> range) {
  return {{"min", range.first}, {"max", range.second}};
}

std::vector<std::uint8_t> deflated(const std::vector<std::uint8_t>& bytes) {
  uLongf size = compressBound(bytes.size());
  std::vector<std::uint8_t> packed(size);
  if (compress2(packed.data(), &size, bytes.data(), bytes.size(), 6) != Z_OK)
    throw std::runtime_error("zlib cannot pack the voxels of the page");
  packed.resize(size);
  return packed;
}

}  // namespace

ViewerModel viewerModel(const MapDocument& document, const RunRecord& record,
                        std::size_t most_cubes) {
  ViewerModel model;
  const int level = LevelSizes(document.map).fitting(most_cubes, kMostTiles);
  const CubePacker packer(document, level);
  model.cubes = packer.cubes().size();
  model.voxels_per_cube = 1 << level;
  if (model.cubes == 0) return model;

  const double edge = document.map.grid().resolution() * model.voxels_per_cube;
  const SignedAxis up = ViewAxes::standing(record.up).up;
  const Json header = {{"resolution", edge},
                       {"tiles", packer.tileCount()},
                       {"voxels", model.cubes},
                       {"vectorEntries", packer.entryCount()},
                       {"voxelsPerCube", model.voxels_per_cube},
                       {"up", {{"axis", up.axis}, {"sign", up.sign}}},
                       {"focus", focusOf(packer.cubes())},
                       {"layers", layersOf(packer.cubes(), up)},
                       {"classes", classesOf(packer, document.labels)},
                       {"classNames", classNamesOf(document)},
                       {"variance", rangeJson(packer.variance())},
                       {"evidence", rangeJson(packer.evidence())},
                       {"trajectories", trajectoriesOf(record, edge)}};
  model.header = header.dump(-1, ' ', false, Json::error_handler_t::replace);
  model.data = deflated(packer.pack());
  return model;
}

}  // namespace csom
