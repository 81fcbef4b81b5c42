// SPDX-License-Identifier: BSD-3-Clause
// What the surfaces of a scan say about the voxels of one chunk (surface-csom).
#pragma once

#include <csom/core/Grid.h>
#include <csom/core/Options.h>
#include <csom/core/types.h>
#include "surface/LocalSurface.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "inference/PointColumns.h"
#include "util/Lanes.h"

namespace csom::detail {

/// Sums over the training points, for each voxel of a chunk: a lane a voxel along x, single
/// precision, in the order of the points. SurfaceCsom.cpp has the equations.
class CSOM_OF_ONE_BINARY SurfaceEvidence {
 public:
  /// Beyond its thickness a plane is evidence against voxels, this far along its normal [voxels].
  /// What is farther off it says nothing about.
  static constexpr float kShell = 0.5F;

  explicit SurfaceEvidence(const Options& options);

  /// Forgets all, and looks at this chunk from now on.
  void reset(const ChunkIndex& chunk);
  /// Points points[begin] … points[end−1] of the scan.
  void add(const PointColumns& points, const std::vector<LocalSurface>& surfaces,
           std::uint32_t begin, std::uint32_t end);
  /// Ends the additions: to be called before what follows. Returns false if there is no evidence.
  bool finish();

  /// Evidence that a voxel is occupied: Σ_{k≥1} Δσ^k of (S5).
  float occupied(int index_in_chunk) const { return get(votes_, index_in_chunk); }
  /// Evidence that it is free: Δσ^0 of (S4).
  float free(int index_in_chunk) const { return get(free_, index_in_chunk); }

 private:
  static_assert(kChunkSide == static_cast<int>(kLanes), "a row of a chunk is a vector of lanes");
  struct alignas(kLaneAlignment) Row {
    Lanes mass;
  };
  using Rows = std::array<Row, std::size_t{kChunkSide} * kChunkSide>;

  static float get(const Rows& rows, int i) {
    return rows[static_cast<std::size_t>(i) / kLanes].mass[static_cast<std::size_t>(i) % kLanes];
  }

  Rows votes_{};    ///< V; after finish() g·V
  Rows support_{};  ///< S
  Rows dense_{};    ///< S, each hit weighted by its density
  Rows free_{};     ///< F; after finish() Δσ^0
  float hit_weight_;
  float tau_;
  float counter_evidence_;
  float free_limit_;
  FixedPoint x_ = 0, y_ = 0, z_ = 0;  ///< lower corner of the chunk
};

}  // namespace csom::detail
