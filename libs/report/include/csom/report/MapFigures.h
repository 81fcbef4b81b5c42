// SPDX-License-Identifier: BSD-3-Clause
// A map in figures: sizes, extent, and how much of each class it holds.
#pragma once

#include <csom/io/LabelSet.h>
#include <csom/io/MapFile.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

namespace csom {

/// What a map holds of one class.
struct ClassFigures {
  ClassId id = kFreeClass;
  std::string name;
  Color color{};
  std::size_t voxels = 0;       ///< voxels whose most likely class this is
  double volume = 0;            ///< of these voxels [m³]
  double share = 0;             ///< of all occupied voxels, 0 … 1; 0 for the free class
  double mean_probability = 0;  ///< of this class over its voxels; 0 if there is none
};

struct MapFigures {
  double resolution = 0;  ///< edge of a voxel [m]
  std::size_t known_voxels = 0;
  std::size_t occupied_voxels = 0;
  std::size_t free_voxels = 0;
  std::size_t chunks = 0;
  std::size_t memory_bytes = 0;
  /// Outer faces of the known voxels [m], map frame; empty() if the map is.
  Eigen::AlignedBox3d bounds;
  std::string digest;                 ///< see mapDigest()
  std::vector<ClassFigures> classes;  ///< every class of the label set, by id
};

/// Visits every voxel of the map once.
MapFigures computeFigures(const MapDocument& document);

/// The same for a map that comes in parts, none of which shares a voxel with another.
class MapFiguresSum {
 public:
  explicit MapFiguresSum(const LabelSet& labels, const Options& options);
  void add(const SemanticMap& part);
  /// Of all parts so far; `digest` is that of the whole map.
  MapFigures figures(const std::string& digest) const;

 private:
  MapFigures sum_;  ///< ClassFigures::mean_probability is the sum over the voxels
};

}  // namespace csom
