// SPDX-License-Identifier: BSD-3-Clause
// Which voxels of a world are free, occupied or out of any sensor's sight.
#include <csom/eval/GroundTruth.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace csom {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// Evidence 1, the mass that a point at the very centre of a voxel would give.
constexpr auto kTruthCount = static_cast<std::uint32_t>(1 / kCountQuantum);

/// Lattice points of a voxel along each axis, and with one more ring of points around it.
constexpr int kPoints = 5;
constexpr int kPadded = kPoints + 2;

/// Where lattice point i (−1 … kPoints) lies along an edge of length 1. The outermost points of the
/// voxel lie just inside, so that a solid that only shares a face with it does not count.
double latticePosition(int i) {
  constexpr double kInset = 1e-6;
  const double position = static_cast<double>(i) / (kPoints - 1);
  const bool inside = i >= 0 && i < kPoints;
  return inside ? std::clamp(position, kInset, 1 - kInset) : position;
}

/// The classes at the lattice points of a voxel and of the ring around them.
class Lattice {
 public:
  ClassId& at(int x, int y, int z) { return classes_[index(x, y, z)]; }

  bool isExposed(int x, int y, int z) const {
    return isFree(x - 1, y, z) || isFree(x + 1, y, z) || isFree(x, y - 1, z) ||
           isFree(x, y + 1, z) || isFree(x, y, z - 1) || isFree(x, y, z + 1);
  }

 private:
  /// −1 ≤ x, y, z ≤ kPoints
  static std::size_t index(int x, int y, int z) {
    return static_cast<std::size_t>((x + 1) + kPadded * ((y + 1) + kPadded * (z + 1)));
  }
  bool isFree(int x, int y, int z) const { return classes_[index(x, y, z)] == kFreeClass; }

  std::array<ClassId, kPadded * kPadded * kPadded> classes_{};
};

template <class Visit>
void forEachPoint(int first, int last, Visit&& visit) {
  for (int z = first; z <= last; ++z)
    for (int y = first; y <= last; ++y)
      for (int x = first; x <= last; ++x) visit(x, y, z);
}

void requireIndexable(const Grid& grid, const AlignedBox3d& region) {
  if (region.isEmpty() || !grid.contains(region.min()) || !grid.contains(region.max())) {
    std::ostringstream text;
    text << "region " << region.min().transpose() << " … " << region.max().transpose()
         << " is empty or beyond the voxels of a grid of " << grid.resolution() << " m";
    throw std::invalid_argument(text.str());
  }
}

}  // namespace

GroundTruth::GroundTruth(const World& world, double resolution) : world_(world), grid_(resolution) {
  if (!(resolution > 0) || !std::isfinite(resolution))
    throw std::invalid_argument("resolution = " + std::to_string(resolution) +
                                ": must be above 0 m");
}

TruthVoxel GroundTruth::at(const VoxelIndex& voxel) const {
  const Vector3d corner = grid_.lowerCorner(voxel);
  const Vector3d edges = Vector3d::Constant(grid_.resolution());
  return classify(voxel, world_.solidsTouching({corner, corner + edges}));
}

TruthVoxel GroundTruth::classify(const VoxelIndex& voxel,
                                 const std::vector<int>& candidates) const {
  const Vector3d corner = grid_.lowerCorner(voxel);
  const AlignedBox3d cube(corner, corner + Vector3d::Constant(grid_.resolution()));
  std::vector<int> touching;
  for (const int index : candidates) {
    const Solid& solid = world_.solids()[static_cast<std::size_t>(index)];
    if (!solid.touches(cube)) continue;
    if (solid.covers(cube)) return {TruthState::Interior, kFreeClass};
    touching.push_back(index);
  }
  if (touching.empty()) return {TruthState::Free, kFreeClass};
  if (touching.size() == 1)
    return {TruthState::Occupied,
            world_.solids()[static_cast<std::size_t>(touching.front())].class_id};
  return classifyOnLattice(corner, touching);
}

TruthVoxel GroundTruth::classifyOnLattice(const Vector3d& corner,
                                          const std::vector<int>& solids) const {
  Lattice lattice;
  forEachPoint(-1, kPoints, [&](int x, int y, int z) {
    const Vector3d at(latticePosition(x), latticePosition(y), latticePosition(z));
    lattice.at(x, y, z) = world_.classAt(corner + grid_.resolution() * at);
  });
  int points_in_solids = 0;
  std::array<int, kMaxClasses> exposed{};
  forEachPoint(0, kPoints - 1, [&](int x, int y, int z) {
    const ClassId id = lattice.at(x, y, z);
    if (id == kFreeClass) return;
    ++points_in_solids;
    if (lattice.isExposed(x, y, z)) ++exposed[id];
  });
  if (points_in_solids == kPoints * kPoints * kPoints) return {TruthState::Interior, kFreeClass};
  const auto most = std::max_element(exposed.begin(), exposed.end());
  if (*most > 0) return {TruthState::Occupied, static_cast<ClassId>(most - exposed.begin())};
  return {TruthState::Occupied, world_.solids()[static_cast<std::size_t>(solids.back())].class_id};
}

VoxelBox GroundTruth::voxelsIn(const AlignedBox3d& region) const {
  requireIndexable(grid_, region);
  // A centre (i+½)·r lies in [lo, hi] from i = ceil(lo/r − ½) to floor(hi/r − ½).
  const Vector3d lo = region.min() / grid_.resolution() - Vector3d::Constant(0.5);
  const Vector3d hi = region.max() / grid_.resolution() - Vector3d::Constant(0.5);
  const auto up = [](double v) { return static_cast<std::int32_t>(std::ceil(v)); };
  const auto down = [](double v) { return static_cast<std::int32_t>(std::floor(v)); };
  const VoxelBox box{{up(lo.x()), up(lo.y()), up(lo.z())},
                     {down(hi.x()), down(hi.y()), down(hi.z())}};
  if (box.min.x > box.max.x || box.min.y > box.max.y || box.min.z > box.max.z)
    throw std::invalid_argument("no voxel centre lies in the region");
  const double voxels =
      (box.max.x - box.min.x + 1.0) * (box.max.y - box.min.y + 1.0) * (box.max.z - box.min.z + 1.0);
  if (voxels > kMaxVoxels) {
    std::ostringstream text;
    text << "region has " << voxels << " voxels of " << grid_.resolution() << " m, at most "
         << kMaxVoxels << " are possible; make it smaller or the voxels larger";
    throw std::invalid_argument(text.str());
  }
  return box;
}

SemanticMap GroundTruth::toMap(const VoxelBox& box) const {
  Options options;
  options.number_of_classes = world_.labels().numberOfClasses();
  options.resolution = grid_.resolution();
  SemanticMap map(options);

  const ChunkIndex first = chunkOf(box.min);
  const ChunkIndex last = chunkOf(box.max);
  const auto inside = [&](const VoxelIndex& v) {
    return box.min.x <= v.x && v.x <= box.max.x && box.min.y <= v.y && v.y <= box.max.y &&
           box.min.z <= v.z && v.z <= box.max.z;
  };
  const Vector3d edges = Vector3d::Constant(kChunkSide * grid_.resolution());
  std::vector<CountIncrement> counts;
  for (std::int32_t z = first.z; z <= last.z; ++z)
    for (std::int32_t y = first.y; y <= last.y; ++y)
      for (std::int32_t x = first.x; x <= last.x; ++x) {
        const ChunkIndex chunk{x, y, z};
        const Vector3d corner = grid_.lowerCorner(voxelOfChunk(chunk, 0));
        const auto candidates = world_.solidsTouching({corner, corner + edges});
        counts.clear();
        for (int i = 0; i < kVoxelsPerChunk; ++i) {
          const VoxelIndex voxel = voxelOfChunk(chunk, i);
          if (!inside(voxel)) continue;
          const TruthVoxel truth = classify(voxel, candidates);
          if (truth.state == TruthState::Interior) continue;
          counts.push_back({static_cast<std::uint16_t>(i), truth.class_id, kTruthCount});
        }
        if (counts.empty()) continue;
        const ChunkRef record = Chunk::sum(nullptr, counts);
        map.addChunkRecord(chunk, record->record(), record->recordSize());
      }
  return map;
}

}  // namespace csom
