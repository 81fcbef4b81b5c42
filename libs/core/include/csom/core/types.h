// SPDX-License-Identifier: BSD-3-Clause
// The vocabulary of the library: classes, integer indices of the grid, and a scan.
#pragma once

#include <csom/core/RangeImage.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

namespace csom {

/// A semantic class. Class 0 is always "free"; see LabelSet (csom::io) for names and colours.
using ClassId = std::uint16_t;
constexpr ClassId kFreeClass = 0;

/// A stored voxel keeps a class in one byte.
constexpr int kMaxClasses = 256;

/// Integer position in one of the grids. The tag keeps voxels, blocks and chunks apart.
template <class Tag>
struct Index3 {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;

  friend bool operator==(const Index3& a, const Index3& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  }
  friend bool operator!=(const Index3& a, const Index3& b) { return !(a == b); }
  /// z-major order: the order in which everything in the library is listed and stored.
  friend bool operator<(const Index3& a, const Index3& b) {
    return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x);
  }
};

/// Voxel (i,j,k) covers [i·r,(i+1)·r) × … in the map frame.
using VoxelIndex = Index3<struct VoxelTag>;
/// A block is the paper's unit of inference: 2^(block_depth−1) voxels a side.
using BlockIndex = Index3<struct BlockTag>;
/// A chunk is the unit of storage: 8 voxels a side.
using ChunkIndex = Index3<struct ChunkTag>;

/// Inclusive box of voxels.
struct VoxelBox {
  VoxelIndex min;
  VoxelIndex max;
};

/// What one observation says: labelled points as seen from one sensor origin.
///
/// Points are *relative to the origin*, with axes parallel to the map's: far from the map's origin
/// (kilometres, UTM coordinates) a float still holds them to a fraction of a millimetre.
///
/// Labels are either hard (`labels`: one class a point, `scores` empty) or soft (`scores`: a
/// row-major matrix points × classes, rows non-negative and summing to 1, `labels` empty).
struct Scan {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< sensor position in the map frame [m]
  std::vector<Eigen::Vector3f> points;               ///< end points relative to origin [m]
  std::vector<ClassId> labels;                       ///< hard labels, or empty
  std::vector<float> scores;                         ///< soft labels, or empty
  RangeImage image;  ///< where points lie beside each other, or empty

  bool isSoft() const { return !scores.empty(); }
};

}  // namespace csom
