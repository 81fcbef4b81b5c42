// SPDX-License-Identifier: BSD-3-Clause
// The exact voxel truth of a simulated world.
#pragma once

#include <csom/core/Grid.h>
#include <csom/core/SemanticMap.h>
#include <csom/eval/World.h>

#include <Eigen/Geometry>
#include <vector>

namespace csom {

/// Free: no solid reaches into the voxel. Occupied: a surface that can be seen passes through it.
/// Interior: solids fill it, so no sensor can say anything about it, and scores leave it out.
enum class TruthState { Free, Occupied, Interior };

struct TruthVoxel {
  TruthState state = TruthState::Free;
  ClassId class_id = kFreeClass;  ///< of an occupied voxel

  friend bool operator==(const TruthVoxel& a, const TruthVoxel& b) {
    return a.state == b.state && a.class_id == b.class_id;
  }
};

/// Truth of the voxels of a grid, computed from the solids themselves:
///
///  1. no solid has a point inside the voxel → free;
///  2. one solid does: interior if it holds the whole voxel, else occupied by its class;
///  3. several do: they are looked at on a lattice of 5×5×5 points, from border to border. Every
///     point in a solid → interior; else occupied by the class with the most *exposed* points (in a
///     solid, with a neighbour in free space; ties: the lower id). If they reach in less than the
///     lattice can see, the solid listed last decides.
///
/// A noise-free sensor of endless density would hit exactly the occupied voxels whose surface it
/// can reach. Keeps a reference to the world, which must outlive it. Thread-safe.
class GroundTruth {
 public:
  /// Throws std::invalid_argument unless resolution > 0.
  GroundTruth(const World& world, double resolution);

  const Grid& grid() const { return grid_; }
  TruthVoxel at(const VoxelIndex& voxel) const;

  /// The voxels whose centre lies in `region`. Throws std::invalid_argument if there are none, or
  /// if they lie beyond what voxel indices can address, or are more than kMaxVoxels.
  VoxelBox voxelsIn(const Eigen::AlignedBox3d& region) const;

  static constexpr double kMaxVoxels = 1e9;

  /// The truth of a box of voxels as a map: an occupied voxel has evidence 1 for its class, a free
  /// one evidence 1 for class 0, an interior one is unknown.
  SemanticMap toMap(const VoxelBox& box) const;

 private:
  TruthVoxel classify(const VoxelIndex& voxel, const std::vector<int>& candidates) const;
  TruthVoxel classifyOnLattice(const Eigen::Vector3d& corner, const std::vector<int>& solids) const;

  const World& world_;
  Grid grid_;
};

}  // namespace csom
