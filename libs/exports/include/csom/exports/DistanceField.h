// SPDX-License-Identifier: BSD-3-Clause
// How far it is to the nearest obstacle, from every voxel of a box.
#pragma once

#include <csom/exports/VoxelSelection.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace csom {

/// The Euclidean distance from a voxel's centre to the centre of the nearest occupied voxel of the
/// selection's classes: 0 in such a voxel, never more than `max_distance`. Obstacles beyond the
/// selection's box count, too.
///
/// The field covers the selection's box, or without one the known voxels, on the grid of the
/// export's frame. It needs 5 bytes a voxel of the box and 12 an obstacle. While it is computed,
/// piece by piece, 28 bytes are needed for each of the about two million voxels of a piece and of
/// what lies within `max_distance` around it; more only if `max_distance` exceeds 40 voxels.
class DistanceField {
 public:
  /// `max_distance` in metres. Throws ConfigError if it is not positive, if no voxel of the map
  /// passes the filters, if the box is empty, or if there would be more than 2^26 voxels.
  DistanceField(const VoxelSelection& voxels, double max_distance);

  /// Of the grid at the origin of the export's frame, inclusive.
  const VoxelBox& box() const { return box_; }
  double resolution() const { return resolution_; }
  double maxDistance() const { return max_distance_; }

  /// Requires the voxel to lie in the box. [m]
  float distance(const VoxelIndex& voxel) const { return distances_[offsetOf(voxel)]; }
  /// Of the map, whatever the filters say.
  VoxelState state(const VoxelIndex& voxel) const { return states_[offsetOf(voxel)]; }

  /// Voxels along x, y, z.
  std::array<int, 3> size() const;

 private:
  std::size_t offsetOf(const VoxelIndex& voxel) const;
  /// Fills in `tile` of the box.
  void measure(const VoxelBox& tile, std::int32_t margin, const std::vector<VoxelIndex>& obstacles);

  double resolution_;
  double max_distance_;
  VoxelBox box_;
  std::vector<float> distances_;  ///< x runs fastest, then y
  std::vector<VoxelState> states_;
};

/// Writes arrays for numpy.load(): `distance` (float32 [m]) and `state` (uint8: 0 unknown, 1 free,
/// 2 occupied), both indexed [z, y, x]; `origin` (centre of the first voxel [m]), `resolution` and
/// `max_distance`. Throws FileError.
void writeDistanceField(const DistanceField& field, const std::string& file);

}  // namespace csom
