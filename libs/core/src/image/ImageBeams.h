// SPDX-License-Identifier: BSD-3-Clause
// The beams of a scan with an image as the innermost loops read them.
#pragma once

#include <csom/core/Options.h>
#include <csom/core/ScanPreparation.h>
#include <csom/core/types.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "image/BeamNeighbours.h"
#include "image/BeamVector.h"

namespace csom::detail {

/// A place in 1/256 of a voxel from the lower corner of a base voxel, rounded to the odd numbers:
/// those never lie on a border between voxels, and a mirrored scan has mirrored ones.
struct HalfStepPosition {
  static constexpr int kBits = 8;
  std::int32_t x, y, z;
};

/// Beams in the order of the image, an array for each property.
struct ImageBeams {
  void read(const PreparedScan& scan, const Options& options);

  std::size_t size() const { return x.size(); }
  /// Where a beam ended, from the sensor [m].
  BeamVector end(std::size_t beam) const { return {x[beam], y[beam], z[beam]}; }

  BeamNeighbours neighbours;
  VoxelIndex base{};  ///< of the positions: lower corner of a chunk
  HalfStepPosition sensor{};
  std::vector<float> x, y, z;               ///< from the sensor [m]
  std::vector<ClassId> label;               ///< the likeliest class of a soft label
  std::vector<HalfStepPosition> positions;  ///< of all points of the scan, in its order
};

}  // namespace csom::detail
