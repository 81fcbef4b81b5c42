// SPDX-License-Identifier: BSD-3-Clause
// The innermost loop: the kernel mass that nearby points give to eight voxels.
#pragma once

#include <csom/core/Options.h>
#include <csom/core/ScanPreparation.h>

#include <array>
#include <cstdint>
#include <vector>

#include "LaneSums.h"
#include "Lanes.h"

namespace csom::detail {

/// Eight voxels of a block (one, if the block is a voxel): positions of their centres relative to
/// the block's lower corner [m].
struct alignas(kLaneAlignment) LaneGroup {
  Lanes x{}, y{}, z{};
  std::array<VoxelIndex, kLanes> voxel{};  ///< relative to the block's first voxel
};

/// The points that may reach a block, relative to the block's lower corner [m].
class NearbyPoints {
 public:
  struct Point {
    float x, y, z;
    std::uint32_t index;  ///< in PreparedScan::points
  };

  /// For a block of edge `edge` whose outermost voxel centres lie `margin` inside it.
  void reset(float edge, float margin, float length) {
    size_ = 0;
    center_ = edge / 2;
    half_ = edge / 2 - margin;
    limit_ = length * length;
  }

  /// Keeps those of the points begin … end−1 of a block `offset` away that are nearer than the
  /// kernel length to the box of the voxel centres.
  void add(const TrainingPoint* points, std::uint32_t begin, std::uint32_t end, float offset_x,
           float offset_y, float offset_z) {
    if (points_.size() < size_ + (end - begin)) points_.resize(2 * (size_ + (end - begin)));
    for (std::uint32_t i = begin; i < end; ++i) {
      const float x = points[i].x + offset_x;
      const float y = points[i].y + offset_y;
      const float z = points[i].z + offset_z;
      const float dx = beyond(x);
      const float dy = beyond(y);
      const float dz = beyond(z);
      points_[size_] = {x, y, z, i};
      size_ += dx * dx + dy * dy + dz * dz < limit_ ? 1 : 0;
    }
  }

  const Point* begin() const { return points_.data(); }
  const Point* end() const { return points_.data() + size_; }

 private:
  /// Distance from the interval of voxel centres along one axis, a little too short so that
  /// rounding never hides a point.
  float beyond(float coordinate) const {
    const float distance = std::abs(coordinate - center_) - half_ * 1.00001F;
    return distance > 0.0F ? distance : 0.0F;
  }

  std::vector<Point> points_;
  std::size_t size_ = 0;
  float center_ = 0;
  float half_ = 0;
  float limit_ = 0;
};

/// Adds the kernel mass of the points to the voxels of a group, in the order of the points, with
/// the labels or (if there are any) the scores of `scan`.
void addKernelMass(Kernel kernel, const LaneGroup& group, const NearbyPoints& points,
                   const PreparedScan& scan, float length, int number_of_classes, LaneSums& sums);

}  // namespace csom::detail
