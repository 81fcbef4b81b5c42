// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/ScanPreparation.h>
#include <csom/core/SemanticMap.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <string>

#include "inference/BoundedWords.h"
#include "inference/Counts.h"
#include "inference/FreeSpaceRays.h"
#include "inference/Inference.h"
#include "scan/PrepareInto.h"
#include "util/Parallel.h"
#include "util/VoxelTraversal.h"

namespace csom {

struct CSOM_OF_ONE_BINARY detail::InsertionMemory {
  PreparedScan prepared;
  ImageMemory image;
};

detail::InsertionMemory& detail::InsertionMemoryOfMap::get() {
  if (!memory_) memory_ = std::make_shared<InsertionMemory>();
  return *memory_;
}

namespace {

/// Milliseconds since the last call.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double, std::milli> elapsed = now - last_;
    last_ = now;
    return elapsed.count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Squared distance from a point to a chunk's nearest voxel centre, or less.
double squaredDistanceToChunk(const Grid& grid, const ChunkIndex& chunk,
                              const Eigen::Vector3d& point) {
  const Eigen::Vector3d lower = grid.lowerCorner(voxelOfChunk(chunk, 0));
  const Eigen::Vector3d upper = lower.array() + kChunkSide * grid.resolution();
  return (point - point.cwiseMax(lower).cwiseMin(upper)).squaredNorm();
}

/// Of a scan without an image. Where free space is projective, so that its word is bounded, that of
/// surfaces is as well.
ScanIncrements findFreeSpace(const PreparedScan& scan, const Options& options,
                             ScanIncrements& surfaces, ScanReport& report) {
  if (options.free_space.mode != FreeSpace::Projective || !options.usesImages())
    return detail::castFreeSpace(scan, options, detail::toCount(options.free_space.weight), report);
  detail::boundWords(surfaces);
  ScanIncrements free = detail::castFreeSpace(scan, options, detail::kWordOfBeams, report);
  detail::keepSurfaces(surfaces, free);
  return free;
}

}  // namespace

SemanticMap::SemanticMap(const Options& options) : options_(options), grid_(options.resolution) {
  options_.validate();
}

ScanReport SemanticMap::insert(const Scan& scan) {
  ScanReport report;
  detail::withThreads(options_.threads, [&] {
    Stopwatch watch;
    detail::InsertionMemory& memory = memory_.get();
    PreparedScan& prepared = memory.prepared;
    detail::prepareScan(scan, options_, report, prepared);
    report.prepare_ms = watch.lap();
    ScanIncrements kernel_mass = detail::inferIncrements(prepared, options_, report, memory.image);
    ScanIncrements free_space;
    if (prepared.image_points.image.empty())
      free_space = findFreeSpace(prepared, options_, kernel_mass, report);
    report.infer_ms = watch.lap();
    store_.add(kernel_mass, options_.threads);
    store_.add(free_space, options_.threads);
    report.commit_ms = watch.lap();
  });
  return report;
}

void SemanticMap::merge(const SemanticMap& other) {
  if (!mergeable(options_, other.options_)) {
    const auto describe = [](const Options& o) {
      return "resolution " + toString(o.resolution) + ", " + toString(o.number_of_classes) +
             " classes, unlabelled_class_id " + toString(o.unlabelled_class_id) + ", prior " +
             toString(o.prior);
    };
    throw std::invalid_argument("maps differ and cannot be merged: " + describe(options_) +
                                " against " + describe(other.options_));
  }
  store_.add(other.store_);
}

void SemanticMap::clear() {
  store_.clear();
  memory_.giveBack();
}

DirichletVoxel SemanticMap::voxel(const VoxelIndex& index) const {
  const ChunkIndex chunk = chunkOf(index);
  return view(isAddressable(chunk) ? store_.find(chunk) : nullptr, indexInChunk(index));
}

DirichletVoxel SemanticMap::at(const Eigen::Vector3d& point) const {
  return grid_.isAddressable(point) ? voxel(grid_.voxelAt(point)) : view(nullptr, 0);
}

std::optional<RayHit> SemanticMap::castRay(const Eigen::Vector3d& origin,
                                           const Eigen::Vector3d& direction, double max_range,
                                           bool stop_at_unknown) const {
  const double norm = direction.norm();
  if (!grid_.isAddressable(origin) || !(norm > 0) || !std::isfinite(norm) || !(max_range > 0))
    return std::nullopt;
  const Eigen::Vector3d unit = direction / norm;
  double range = max_range;
  for (int axis = 0; axis < 3; ++axis) {  // end where indices end
    if (unit[axis] == 0) continue;
    const double end =
        grid_.resolution() * (unit[axis] > 0 ? kLastVoxelIndex + 1.0 : kFirstVoxelIndex);
    range = std::min(range, std::max(0.0, (end - origin[axis]) / unit[axis]));
  }

  std::optional<RayHit> hit;
  ChunkIndex cached_index;
  const Chunk* cached = nullptr;
  bool first = true;
  detail::traverseVoxels(grid_, origin, origin + range * unit,
                         [&](const VoxelIndex& index, double entered) {
                           if (!isAddressable(chunkOf(index))) return false;
                           if (first || chunkOf(index) != cached_index) {
                             first = false;
                             cached_index = chunkOf(index);
                             cached = store_.find(cached_index);
                           }
                           const DirichletVoxel here = view(cached, indexInChunk(index));
                           const VoxelState state = here.state();
                           if (state == VoxelState::Occupied) {
                             hit = RayHit{index, origin + entered * range * unit, entered * range,
                                          here.mostLikelyClass()};
                             return false;
                           }
                           return !(stop_at_unknown && state == VoxelState::Unknown);
                         });
  return hit;
}

std::optional<Neighbour> SemanticMap::nearestOccupied(const Eigen::Vector3d& point,
                                                      double max_distance,
                                                      std::optional<ClassId> only_class) const {
  if (!grid_.isAddressable(point) || !(max_distance >= 0)) return std::nullopt;
  double best_squared = max_distance * max_distance;
  std::optional<Neighbour> best;
  const auto consider = [&](const ChunkIndex& index, const Chunk& chunk) {
    if (squaredDistanceToChunk(grid_, index, point) > best_squared) return;
    chunk.forEachKnown([&](int in_chunk) {
      const VoxelIndex candidate = voxelOfChunk(index, in_chunk);
      const double squared = (grid_.center(candidate) - point).squaredNorm();
      if (squared > best_squared || (best && squared == best_squared && best->voxel < candidate))
        return;
      const DirichletVoxel v = view(&chunk, in_chunk);
      if (v.state() != VoxelState::Occupied || (only_class && v.mostLikelyClass() != *only_class))
        return;
      best_squared = squared;
      best = Neighbour{candidate, std::sqrt(squared), v.mostLikelyClass()};
    });
  };

  // Shells of chunks around the point's own, until the next shell is farther than the best found;
  // all chunks at once where that is less work.
  const double chunk_edge = kChunkSide * grid_.resolution();
  const double shells = std::ceil(max_distance / chunk_edge) + 1;
  if (std::pow(2 * shells + 1, 3) > static_cast<double>(store_.chunkCount())) {
    store_.forEach(consider);
    return best;
  }
  const ChunkIndex center = chunkOf(grid_.voxelAt(point));
  const auto last_shell = static_cast<std::int32_t>(shells);
  for (std::int32_t shell = 0; shell <= last_shell; ++shell) {
    const double nearest = (shell - 1) * chunk_edge;
    if (nearest > 0 && nearest * nearest > best_squared) break;
    for (std::int32_t z = -shell; z <= shell; ++z)
      for (std::int32_t y = -shell; y <= shell; ++y) {
        const bool face = std::abs(z) == shell || std::abs(y) == shell;
        for (std::int32_t x = -shell; x <= shell; x += face || shell == 0 ? 1 : 2 * shell) {
          const ChunkIndex index{center.x + x, center.y + y, center.z + z};
          if (!isAddressable(index)) continue;
          if (const Chunk* chunk = store_.find(index)) consider(index, *chunk);
        }
      }
  }
  return best;
}

std::optional<VoxelBox> SemanticMap::boundingBox() const {
  std::optional<VoxelBox> box;
  store_.forEach([&](const ChunkIndex& index, const Chunk& chunk) {
    chunk.forEachKnown([&](int in_chunk) {
      const VoxelIndex v = voxelOfChunk(index, in_chunk);
      if (!box) box = VoxelBox{v, v};
      box->min = {std::min(box->min.x, v.x), std::min(box->min.y, v.y), std::min(box->min.z, v.z)};
      box->max = {std::max(box->max.x, v.x), std::max(box->max.y, v.y), std::max(box->max.z, v.z)};
    });
  });
  return box;
}

std::size_t SemanticMap::knownVoxelCount() const {
  std::size_t count = 0;
  store_.forEach([&](const ChunkIndex&, const Chunk& chunk) {
    count += static_cast<std::size_t>(chunk.knownVoxels());
  });
  return count;
}

std::size_t SemanticMap::memoryBytes() const {
  return store_.memoryBytes();
}

void SemanticMap::addChunkRecord(const ChunkIndex& index, const void* bytes, std::size_t size) {
  if (!isAddressable(index))
    throw std::runtime_error("chunk index (" + std::to_string(index.x) + ", " +
                             std::to_string(index.y) + ", " + std::to_string(index.z) +
                             ") is outside the addressable range");
  store_.add(index, Chunk::fromRecord(bytes, size, options_.number_of_classes));
}

}  // namespace csom
