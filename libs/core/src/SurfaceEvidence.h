// SPDX-License-Identifier: BSD-3-Clause
// What the surfaces of a scan say about the voxels of one chunk (surface-csom).
#pragma once

#include <csom/core/Grid.h>
#include <csom/core/LocalSurface.h>
#include <csom/core/types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "Lanes.h"
#include "PointColumns.h"

namespace csom::detail {

/// Sums over the training points, for each voxel of a chunk: a lane a voxel along x, single
/// precision, in the order of the points.
class SurfaceEvidence {
 public:
  /// `hit_weight`: additional mass for the voxel that a hit lies in.
  explicit SurfaceEvidence(float hit_weight) : hit_weight_(hit_weight) {}

  /// Forgets all, and looks at this chunk from now on.
  void reset(const ChunkIndex& chunk);
  /// Points points[begin] … points[end−1] of the scan.
  void add(const PointColumns& points, const std::vector<LocalSurface>& surfaces,
           std::uint32_t begin, std::uint32_t end);

  /// Mass for the voxel: of surfaces that pass through it …
  float votes(int index_in_chunk) const { return get(votes_, index_in_chunk); }
  /// … and that of all surfaces that could: `votes` and those that pass beside it.
  float support(int index_in_chunk) const { return get(support_, index_in_chunk); }
  /// Mean density of the hits that support it, 0 … 1.
  float density(int index_in_chunk) const {
    const float mass = support(index_in_chunk);
    return mass > 0 ? get(dense_, index_in_chunk) / mass : 0;
  }
  /// Mass of free samples.
  float free(int index_in_chunk) const { return get(free_, index_in_chunk); }
  /// All points that gave votes are nearer than this [voxels].
  float reach(int index_in_chunk) const { return get(reach_, index_in_chunk); }

 private:
  static_assert(kChunkSide == static_cast<int>(kLanes), "a row of a chunk is a vector of lanes");
  struct alignas(kLaneAlignment) Row {
    Lanes mass;
  };
  using Rows = std::array<Row, std::size_t{kChunkSide} * kChunkSide>;

  static float get(const Rows& rows, int i) {
    return rows[static_cast<std::size_t>(i) / kLanes].mass[static_cast<std::size_t>(i) % kLanes];
  }

  Rows votes_{};
  Rows support_{};
  Rows dense_{};
  Rows free_{};
  Rows reach_{};
  float hit_weight_;
  FixedPoint x_ = 0, y_ = 0, z_ = 0;  ///< lower corner of the chunk
};

}  // namespace csom::detail
