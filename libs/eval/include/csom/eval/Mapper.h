// SPDX-License-Identifier: BSD-3-Clause
// What every method that is compared looks like: scans in, estimates of voxels out.
#pragma once

#include <csom/core/types.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

namespace csom {

/// What a map says about a voxel.
struct VoxelEstimate {
  bool known = false;      ///< false: the map has no evidence of it, and the rest says nothing
  double occupancy = 0.5;  ///< probability that it is occupied
  ClassId class_id = kFreeClass;  ///< of an occupied voxel; kFreeClass if free or unknown
  /// λ of each class, free first; of a method without classes only [1 − occupancy, occupancy].
  std::vector<double> probabilities;
  /// What a surface in the voxel would be, even where it is held to be free; kFreeClass if the
  /// method does not know.
  ClassId surface_class = kFreeClass;
};

/// A map under test. One instance, one map. Frames and units as in SemanticMap: map frame, metres.
/// Not thread-safe.
class Mapper {
 public:
  virtual ~Mapper() = default;

  /// Adds one scan with hard labels. Throws std::invalid_argument if labels and points differ in
  /// number.
  virtual void insert(const Scan& scan) = 0;

  /// What the map says about the point in the middle of a voxel.
  virtual VoxelEstimate at(const Eigen::Vector3d& center) const = 0;

  /// False for a method that knows occupancy alone.
  virtual bool hasClasses() const = 0;
};

}  // namespace csom
