// SPDX-License-Identifier: BSD-3-Clause
// The training points of a scan as the innermost loops read them: an array for each coordinate.
#pragma once

#include <csom/core/Grid.h>
#include <csom/core/ScanPreparation.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "util/Lanes.h"

namespace csom::detail {

/// A coordinate in units of 2⁻¹⁷ of a voxel, modulo 2³². That is how training points are rounded,
/// so nothing is lost, and differences of less than 2¹⁴ voxels come out exactly, wherever in the
/// map the two lie.
using FixedPoint = std::uint32_t;
constexpr int kFixedPointBits = 17;
constexpr FixedPoint kFixedPointVoxel = FixedPoint{1} << kFixedPointBits;

inline FixedPoint fixedPoint(std::int32_t voxel) {
  return static_cast<FixedPoint>(voxel) << kFixedPointBits;
}

/// Where a block lies.
struct BlockPlace {
  FixedPoint x, y, z;  ///< lower corner
  FixedPoint edge;
};
inline BlockPlace blockPlace(const BlockLayout& layout, const BlockIndex& block) {
  const int bits = layout.sideBits();
  return {fixedPoint(block.x) << bits, fixedPoint(block.y) << bits, fixedPoint(block.z) << bits,
          fixedPoint(1) << bits};
}

/// All points of a scan, in its order.
struct PointColumns {
  explicit PointColumns(const PreparedScan& scan) {
    // Whole vectors are read, also beyond the last point.
    for (std::vector<FixedPoint>* axis : {&x, &y, &z}) axis->resize(scan.points.size() + kLanes);
    label.resize(scan.points.size());
    const auto within = [](float voxels) {
      return static_cast<FixedPoint>(static_cast<std::int32_t>(voxels * kFixedPointVoxel));
    };
    for (std::size_t b = 0; b < scan.blocks.size(); ++b) {
      const BlockPlace block = blockPlace(scan.layout, scan.blocks[b]);
      for (std::uint32_t i = scan.block_begin[b]; i < scan.block_begin[b + 1]; ++i) {
        const TrainingPoint& p = scan.points[i];
        x[i] = block.x + within(p.x);
        y[i] = block.y + within(p.y);
        z[i] = block.z + within(p.z);
        label[i] = p.label;
      }
    }
  }

  std::vector<FixedPoint> x, y, z;
  std::vector<ClassId> label;
};

}  // namespace csom::detail
