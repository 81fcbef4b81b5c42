// SPDX-License-Identifier: BSD-3-Clause
// What is true of every voxel of a box, and which voxels are not scored.
#pragma once

#include <csom/core/Grid.h>
#include <csom/core/SemanticMap.h>

#include <optional>
#include <vector>

namespace csom {

/// The truth as scores use it: each voxel of a box is free, occupied by a class, or left out.
///
/// Made of a map of the truth. Where that knows free voxels (a simulated world), the box is that of
/// its known voxels and those that it does not know are left out; where it does not (a labelled
/// point cloud), the box is padded and all that it does not know is free.
class VoxelTruth {
 public:
  /// Throws std::invalid_argument if the map is empty or the box has more than kMaxVoxels.
  explicit VoxelTruth(const SemanticMap& truth, double padding = 0.5);

  static constexpr double kMaxVoxels = 1e9;

  /// Leaves a voxel out, whatever is known of it; nothing happens beyond the box.
  void leaveOut(const VoxelIndex& voxel);
  /// Leaves out all voxels that this map, of the same grid, does not know.
  void keepOnly(const SemanticMap& known);

  const Grid& grid() const { return grid_; }
  int numberOfClasses() const { return classes_; }
  /// True if it was told which voxels are free, rather than taking for free what nobody saw.
  bool knowsFree() const { return knows_free_; }

  /// The class of a voxel, kFreeClass if it is free; nothing if it is left out or beyond the box.
  std::optional<ClassId> at(const VoxelIndex& voxel) const;

  /// Calls `visit(center of the voxel, ClassId)` for all that are not left out, in z-major order.
  template <class Visitor>
  void forEach(Visitor&& visit) const;

 private:
  static constexpr ClassId kLeftOut = 0xffff;

  bool contains(const VoxelIndex& voxel) const;
  std::size_t indexOf(const VoxelIndex& voxel) const;

  Grid grid_;
  int classes_;
  bool knows_free_ = false;
  VoxelBox box_;
  std::vector<ClassId> voxels_;  ///< x fastest, then y, then z
};

template <class Visitor>
void VoxelTruth::forEach(Visitor&& visit) const {
  auto next = voxels_.begin();
  for (std::int32_t z = box_.min.z; z <= box_.max.z; ++z)
    for (std::int32_t y = box_.min.y; y <= box_.max.y; ++y)
      for (std::int32_t x = box_.min.x; x <= box_.max.x; ++x, ++next)
        if (*next != kLeftOut) visit(grid_.center({x, y, z}), *next);
}

}  // namespace csom
