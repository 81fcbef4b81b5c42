// SPDX-License-Identifier: BSD-3-Clause
// The map a user holds: scans go in, answers come out.
#pragma once

#include <csom/core/ChunkStore.h>
#include <csom/core/DirichletVoxel.h>
#include <csom/core/Grid.h>
#include <csom/core/Options.h>
#include <csom/core/ScanReport.h>
#include <csom/core/types.h>

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>

namespace csom {

/// Where a ray ended.
struct RayHit {
  VoxelIndex voxel;
  Eigen::Vector3d point;  ///< where the ray enters that voxel [m]
  double distance = 0;    ///< from the ray's origin to `point` [m]
  ClassId class_id = kFreeClass;
};

/// An occupied voxel near a point.
struct Neighbour {
  VoxelIndex voxel;
  double distance = 0;  ///< from the query point to the voxel's centre [m]
  ClassId class_id = kFreeClass;
};

namespace detail {

struct InsertionMemory;

/// What an insertion takes its temporary memory from, so that the next one need not ask the system
/// for it again: some 30 MB after scans of a LiDAR. Copies of a map begin without; clear() gives it
/// back.
class InsertionMemoryOfMap {
 public:
  InsertionMemoryOfMap() = default;
  InsertionMemoryOfMap(const InsertionMemoryOfMap&) {}
  InsertionMemoryOfMap(InsertionMemoryOfMap&&) = default;
  InsertionMemoryOfMap& operator=(const InsertionMemoryOfMap&) { return *this; }
  InsertionMemoryOfMap& operator=(InsertionMemoryOfMap&&) = default;
  ~InsertionMemoryOfMap() = default;

  InsertionMemory& get();
  void giveBack() { memory_.reset(); }

 private:
  std::shared_ptr<InsertionMemory> memory_;
};

}  // namespace detail

/// A continuous semantic occupancy map: the sum of the increments of its scans.
///
/// Frames and units: map frame, metres, radians. Thread-safety: any number of threads may call
/// const members of one map at a time while no thread calls a non-const one. Copies share storage
/// (copy-on-write) and may be used in different threads without locks.
class SemanticMap {
 public:
  /// Throws OptionError.
  explicit SemanticMap(const Options& options = {});

  const Options& options() const { return options_; }
  const Grid& grid() const { return grid_; }

  /// Adds one scan. Bad points are rejected and counted, never thrown for. Throws
  /// std::invalid_argument, and leaves the map as it was, if labels, scores or the image do not
  /// match the points or free samples are too many (see ScanPreparation.h).
  ScanReport insert(const Scan& scan);

  /// Adds another map of the same resolution, classes and prior, exactly: merge(a,b) holds the same
  /// bits as one map that received the scans of both. Throws std::invalid_argument otherwise.
  void merge(const SemanticMap& other);

  void clear();
  bool empty() const { return store_.chunkCount() == 0; }

  /// The voxel that holds a point; unknown outside of the addressable range.
  DirichletVoxel at(const Eigen::Vector3d& point) const;
  DirichletVoxel voxel(const VoxelIndex& index) const;

  /// First occupied voxel along a ray, by exact voxel traversal. The voxel of the origin counts.
  /// With `stop_at_unknown` the ray also ends (without a hit) at the first unknown voxel.
  /// `direction` need not be normalised; a zero or non-finite direction hits nothing.
  std::optional<RayHit> castRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                double max_range, bool stop_at_unknown = false) const;

  /// Occupied voxel whose centre is nearest to `point`, at most `max_distance` away (ties: the
  /// lowest index). With `only_class`, of that class alone.
  std::optional<Neighbour> nearestOccupied(const Eigen::Vector3d& point, double max_distance,
                                           std::optional<ClassId> only_class = std::nullopt) const;

  /// Calls `visit(VoxelIndex, DirichletVoxel)` for every known voxel, chunk by chunk in z-major
  /// order: the same order for equal maps.
  template <class Visitor>
  void forEachVoxel(Visitor&& visit) const;

  /// The same for the known voxels of an inclusive box of voxels.
  template <class Visitor>
  void forEachVoxelInBox(const VoxelBox& box, Visitor&& visit) const;

  /// The smallest box with all known voxels; nothing if the map is empty.
  std::optional<VoxelBox> boundingBox() const;

  std::size_t knownVoxelCount() const;
  /// Bytes of all chunks and of the table that finds them. Chunks shared with copies count fully.
  std::size_t memoryBytes() const;

  /// The storage, for readers and writers of files and streams.
  const ChunkStore& chunks() const { return store_; }
  /// Adds the counts of a chunk record (see Chunk.h) to this map. Throws std::runtime_error
  /// with the reason if the bytes are not a valid record of a map with `number_of_classes` classes.
  void addChunkRecord(const ChunkIndex& index, const void* bytes, std::size_t size);

 private:
  DirichletVoxel view(const Chunk::Entries& entries) const {
    return {options_.number_of_classes,
            options_.prior,
            static_cast<ClassId>(options_.unlabelled_class_id),
            entries.classes,
            entries.counts,
            entries.size};
  }
  DirichletVoxel view(const Chunk* chunk, int index_in_chunk) const {
    return view(chunk == nullptr ? Chunk::Entries{} : chunk->at(index_in_chunk));
  }

  Options options_;
  Grid grid_;
  ChunkStore store_;
  detail::InsertionMemoryOfMap memory_;
};

// ---------------------------------------------------------------------------------------------

template <class Visitor>
void SemanticMap::forEachVoxel(Visitor&& visit) const {
  for (const auto& [index, chunk] : store_.sorted()) {
    const ChunkIndex origin = index;
    chunk->forEachVoxel([&](int in_chunk, const Chunk::Entries& entries) {
      visit(voxelOfChunk(origin, in_chunk), view(entries));
    });
  }
}

template <class Visitor>
void SemanticMap::forEachVoxelInBox(const VoxelBox& box, Visitor&& visit) const {
  const auto inside = [](std::int32_t v, std::int32_t min, std::int32_t max) {
    return min <= v && v <= max;
  };
  for (const auto& [index, chunk] : store_.sorted(chunkOf(box.min), chunkOf(box.max))) {
    const ChunkIndex origin = index;
    chunk->forEachVoxel([&](int in_chunk, const Chunk::Entries& entries) {
      const VoxelIndex v = voxelOfChunk(origin, in_chunk);
      if (inside(v.x, box.min.x, box.max.x) && inside(v.y, box.min.y, box.max.y) &&
          inside(v.z, box.min.z, box.max.z))
        visit(v, view(entries));
    });
  }
}

}  // namespace csom
