// SPDX-License-Identifier: BSD-3-Clause
// The classes of the hits around the voxels of a chunk (surface-csom).
#pragma once

#include <csom/core/Options.h>
#include <csom/core/types.h>
#include "surface/LocalSurface.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "inference/Counts.h"
#include "inference/KernelMass.h"
#include "inference/LaneSums.h"
#include "inference/PointColumns.h"

namespace csom::detail {

/// Hits as PointColumns has them, and how far each one reaches [voxels].
struct HitColumns {
  std::vector<FixedPoint> x, y, z;
  std::vector<ClassId> label;
  std::vector<float> reach;
};

/// m^k of (S5): kernel mass by class, each hit with the length max(L_J, its own reach), so that
/// whatever votes for a voxel also has a class for it.
class SurfaceClasses {
 public:
  explicit SurfaceClasses(const Options& options)
      : kernel_(options.kernel.shape), sums_(options.number_of_classes) {}

  /// Forgets all hits.
  void clear();
  /// Hits points[begin] … points[end−1] of a scan; `scores` of all its points, or none. Free
  /// samples tell no class.
  void add(const PointColumns& points, const std::vector<LocalSurface>& surfaces,
           const std::vector<float>& scores, std::uint32_t begin, std::uint32_t end);

  /// Turns to a block, whose kernel length is L_J [voxels].
  void select(const BlockPlace& block, float length);
  /// If all hits near the block have one label, that.
  std::optional<ClassId> onlyClass() const;
  /// Divides mass of the voxels of a group of the block among the classes k ≥ 1 by m^k, as counts;
  /// appends the classes with any mass, ascending, and their counts.
  void divide(const LaneGroup& group, const std::array<float, kLanes>& occupied, double scale,
              std::vector<ClassId>& classes, std::vector<CountLanes>& counts);

 private:
  Kernel kernel_;
  LaneSums sums_;
  // In the order of the scan; coordinates and reaches are padded by whole vectors.
  HitColumns hits_;
  std::size_t size_ = 0;
  std::vector<float> scores_;
  // Of them, those near the block.
  BlockPlace block_{};
  float length_ = 0;
  std::vector<std::uint32_t> selected_;
};

}  // namespace csom::detail
