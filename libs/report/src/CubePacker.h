// SPDX-License-Identifier: BSD-3-Clause
// The occupied voxels of a map in the order and the bytes of the page.
#pragma once

#include <csom/core/SemanticMap.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace csom {

/// Edges of cubes are 1, 2, 4 or 8 voxels: at level 0 a cube is a voxel.
constexpr int kCubeLevels = kChunkBits + 1;

/// The finest level with at most so many cubes and tiles of 32×32×32 cubes; else the coarsest.
int cubeLevel(const SemanticMap& map, std::size_t most_cubes, std::size_t most_tiles);

struct Cube {
  std::array<std::int32_t, 3> tile{};
  std::uint16_t place = 0;  ///< x + 32·y + 1024·z in the tile
  float evidence = 0;
  float variance = 0;  ///< of the most likely class
  std::uint8_t vector_size = 0;
  std::uint32_t vector_begin = 0;

  /// Index of the cube along each axis.
  std::array<std::int32_t, 3> index() const;
};

/// See ViewerModel for the bytes.
class CubePacker {
 public:
  /// Of the voxels of a cube it keeps the one of most evidence.
  CubePacker(const SemanticMap& map, int level);

  /// By tile, then by place.
  const std::vector<Cube>& cubes() const { return cubes_; }
  std::size_t tileCount() const { return tiles_; }
  std::size_t entryCount() const { return entries_; }
  /// Least and greatest; the least is at least a millionth of the greatest.
  std::pair<double, double> evidence() const { return evidence_; }
  std::pair<double, double> variance() const { return variance_; }
  ClassId classOf(const Cube& cube) const { return classes_[cube.vector_begin]; }

  std::vector<std::uint8_t> pack() const;

 private:
  void add(const VoxelIndex& cube, const DirichletVoxel& voxel);
  void addVector(const DirichletVoxel& voxel, ClassId best);
  void keepBestOfEachCube();
  std::pair<double, double> rangeOf(float Cube::*field) const;
  bool startsTile(std::size_t i) const;
  void packTiles(std::vector<std::uint8_t>& bytes) const;

  std::vector<Cube> cubes_;
  std::vector<std::uint8_t> classes_;
  std::vector<std::uint8_t> probabilities_;
  std::vector<std::pair<std::uint8_t, ClassId>> vector_;  ///< scratch
  std::size_t tiles_ = 0;
  std::size_t entries_ = 0;
  std::pair<double, double> evidence_;
  std::pair<double, double> variance_;
};

}  // namespace csom
