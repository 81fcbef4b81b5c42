// SPDX-License-Identifier: BSD-3-Clause
// Which occupied voxel is the nearest, remembered for whole chunks.
#include <csom/maps/NearestVoxelField.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace csom {
namespace {

constexpr std::int32_t kNone = -1;

/// Voxels farther than this from a chunk do not count: their squared distance fits into 32 bits.
constexpr double kMaxReach = 20000;

std::vector<VoxelIndex> occupiedAround(const SemanticMap& map, const ChunkIndex& chunk,
                                       std::int32_t reach) {
  const VoxelIndex first = voxelOfChunk(chunk, 0);
  const VoxelIndex last = voxelOfChunk(chunk, kVoxelsPerChunk - 1);
  const VoxelBox box{{first.x - reach, first.y - reach, first.z - reach},
                     {last.x + reach, last.y + reach, last.z + reach}};
  std::vector<VoxelIndex> occupied;
  map.forEachVoxelInBox(box, [&](const VoxelIndex& index, const DirichletVoxel& voxel) {
    if (voxel.state() == VoxelState::Occupied) occupied.push_back(index);
  });
  return occupied;
}

std::int32_t squared(std::int32_t value) {
  return value * value;
}

}  // namespace

NearestVoxelTile::NearestVoxelTile(const SemanticMap& map, const ChunkIndex& chunk, double reach) {
  const double limit = std::min(reach, kMaxReach);
  const std::vector<VoxelIndex> occupied =
      occupiedAround(map, chunk, static_cast<std::int32_t>(limit));
  if (occupied.empty()) return;

  // Each occupied voxel is offered to all rows of the chunk: eight voxels at once.
  std::array<std::int32_t, kVoxelsPerChunk> best{};
  std::array<std::int32_t, kVoxelsPerChunk> winner{};
  best.fill(static_cast<std::int32_t>(limit * limit) + 1);
  winner.fill(kNone);
  const VoxelIndex origin = voxelOfChunk(chunk, 0);
  for (std::size_t k = 0; k < occupied.size(); ++k) {
    const auto candidate = static_cast<std::int32_t>(k);
    const VoxelIndex& v = occupied[k];
    std::array<std::int32_t, kChunkSide> along_x{};
    for (std::int32_t x = 0; x < kChunkSide; ++x)
      along_x[static_cast<std::size_t>(x)] = squared(v.x - origin.x - x);
    for (std::int32_t row = 0; row < kChunkSide * kChunkSide; ++row) {
      const std::int32_t beside =
          squared(v.y - origin.y - row % kChunkSide) + squared(v.z - origin.z - row / kChunkSide);
      const auto begin = static_cast<std::size_t>(row * kChunkSide);
      for (std::size_t x = 0; x < kChunkSide; ++x) {
        const std::int32_t distance = beside + along_x[x];
        const bool nearer = distance < best[begin + x];
        winner[begin + x] = nearer ? candidate : winner[begin + x];
        best[begin + x] = nearer ? distance : best[begin + x];
      }
    }
  }

  std::vector<std::int32_t> position(occupied.size(), kNone);
  nearest_.resize(kVoxelsPerChunk, std::numeric_limits<std::uint16_t>::max());
  for (std::size_t i = 0; i < nearest_.size(); ++i) {
    if (winner[i] == kNone) continue;
    std::int32_t& at = position[static_cast<std::size_t>(winner[i])];
    if (at == kNone) {
      at = static_cast<std::int32_t>(voxels_.size());
      voxels_.push_back(occupied[static_cast<std::size_t>(winner[i])]);
    }
    nearest_[i] = static_cast<std::uint16_t>(at);
  }
  if (voxels_.empty()) nearest_.clear();
  voxels_.shrink_to_fit();
}

const VoxelIndex* NearestVoxelTile::nearest(int index_in_chunk) const {
  if (nearest_.empty()) return nullptr;
  const std::size_t at = nearest_[static_cast<std::size_t>(index_in_chunk)];
  return at < voxels_.size() ? &voxels_[at] : nullptr;
}

NearestVoxelField& NearestVoxelField::operator=(const NearestVoxelField& other) {
  if (this != &other) invalidate();
  return *this;
}

const NearestVoxelTile& NearestVoxelField::tile(const SemanticMap& map, const ChunkIndex& chunk,
                                                double reach) const {
  {
    const std::lock_guard lock(mutex_);
    if (reach != reach_) {
      tiles_.clear();
      reach_ = reach;
    }
    const auto known = tiles_.find(chunk);
    if (known != tiles_.end()) return *known->second;
  }
  // Without the lock: other threads need not wait. If two make the same tile, the first one counts.
  auto made = std::make_unique<const NearestVoxelTile>(map, chunk, reach);
  const std::lock_guard lock(mutex_);
  return *tiles_.emplace(chunk, std::move(made)).first->second;
}

void NearestVoxelField::invalidate() {
  const std::lock_guard lock(mutex_);
  tiles_.clear();
}

NearestVoxelReader::NearestVoxelReader(const NearestVoxelField& field, const SemanticMap& map,
                                       double max_distance)
    : field_(field),
      map_(map),
      max_distance_(max_distance),
      // A point may lie half a diagonal away from the centre of its voxel.
      reach_(max_distance / map.grid().resolution() + std::sqrt(0.75)) {}

std::optional<NearestVoxelReader::Found> NearestVoxelReader::nearest(const Eigen::Vector3d& point) {
  if (!map_.grid().contains(point)) return std::nullopt;
  const VoxelIndex own = map_.grid().voxelAt(point);
  const ChunkIndex chunk = chunkOf(own);
  if (last_tile_ == nullptr || chunk != last_chunk_) {
    last_tile_ = &field_.tile(map_, chunk, reach_);
    last_chunk_ = chunk;
  }
  const VoxelIndex* const voxel = last_tile_->nearest(indexInChunk(own));
  if (voxel == nullptr) return std::nullopt;
  const double distance = (map_.grid().center(*voxel) - point).norm();
  if (distance > max_distance_) return std::nullopt;
  return Found{*voxel, distance};
}

}  // namespace csom
