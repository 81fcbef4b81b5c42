// SPDX-License-Identifier: BSD-3-Clause
// Which occupied voxel is the nearest, remembered for whole chunks.
#pragma once

#include <csom/core/SemanticMap.h>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace csom {

/// For each voxel of one chunk the occupied voxel whose centre is nearest to its own (of several
/// the one that is visited first by forEachVoxelInBox).
class NearestVoxelTile {
 public:
  /// Occupied voxels that reach the chunk are looked for `reach` voxels around it.
  NearestVoxelTile(const SemanticMap& map, const ChunkIndex& chunk, double reach);
  /// Null if there is none within reach of the voxel's centre.
  const VoxelIndex* nearest(int index_in_chunk) const;

 private:
  std::vector<VoxelIndex> voxels_;      ///< those that are the nearest of any
  std::vector<std::uint16_t> nearest_;  ///< 512 positions in voxels_; empty if there are none
};

/// A cache of tiles, each made when it is first asked for. tile() may be called from several
/// threads at a time; copies start empty.
class NearestVoxelField {
 public:
  NearestVoxelField() = default;
  NearestVoxelField(const NearestVoxelField&) {}
  NearestVoxelField& operator=(const NearestVoxelField&);

  /// The tile of a chunk of `map`, as of the last invalidate(). Valid until then, and as long as
  /// `reach` [voxels] remains the same in all calls.
  const NearestVoxelTile& tile(const SemanticMap& map, const ChunkIndex& chunk, double reach) const;
  void invalidate();

 private:
  mutable std::mutex mutex_;
  mutable double reach_ = 0;
  mutable std::map<ChunkIndex, std::unique_ptr<const NearestVoxelTile>> tiles_;
};

/// Answers for points, by one thread: neighbouring points find their tile without the cache's lock.
class NearestVoxelReader {
 public:
  /// All three must outlive the reader, and the map must not change meanwhile.
  NearestVoxelReader(const NearestVoxelField& field, const SemanticMap& map, double max_distance);

  struct Found {
    VoxelIndex voxel;
    double distance = 0;  ///< from the point to the voxel's centre, at most max_distance [m]
  };
  /// The occupied voxel that is nearest to the centre of the point's own voxel; its distance is
  /// longer than that to the voxel nearest to the point by at most a voxel's diagonal, and rarely
  /// by a tenth of it.
  std::optional<Found> nearest(const Eigen::Vector3d& point);

 private:
  const NearestVoxelField& field_;
  const SemanticMap& map_;
  double max_distance_;
  double reach_;
  ChunkIndex last_chunk_;
  const NearestVoxelTile* last_tile_ = nullptr;
};

}  // namespace csom
