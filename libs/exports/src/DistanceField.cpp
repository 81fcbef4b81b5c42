// SPDX-License-Identifier: BSD-3-Clause
// How far it is to the nearest obstacle, from every voxel of a box.
#include <csom/core/Error.h>
#include <csom/exports/DistanceField.h>
#include <dynamicEDT3D/dynamicEDT3D.h>

#include <algorithm>
#include <cmath>

#include "BinaryNumbers.h"
#include "NumpyArchive.h"

namespace csom {
namespace {

constexpr std::int64_t kMaxVoxels = std::int64_t{1} << 26U;

/// Voxels that are computed at a time, as DynamicEDT3D takes 28 bytes for each.
constexpr std::int64_t kMaxTileVoxels = std::int64_t{1} << 21U;

std::int64_t volume(const VoxelBox& box) {
  return (std::int64_t{box.max.x} - box.min.x + 1) * (std::int64_t{box.max.y} - box.min.y + 1) *
         (std::int64_t{box.max.z} - box.min.z + 1);
}

bool contains(const VoxelBox& box, const VoxelIndex& v) {
  return box.min.x <= v.x && v.x <= box.max.x && box.min.y <= v.y && v.y <= box.max.y &&
         box.min.z <= v.z && v.z <= box.max.z;
}

VoxelBox computeBox(const VoxelSelection& everything, const VoxelSelection& voxels) {
  if (!voxels.filter().box) {
    const auto known = everything.resampledBounds();
    if (!known) throw ConfigError("the map is empty: there is nothing to export");
    return *known;
  }
  Eigen::AlignedBox3d moved;
  for (int i = 0; i < 8; ++i)
    moved.extend(voxels.frame() *
                 voxels.filter().box->corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
  const auto box = voxelsWithCenterIn(voxels.map().grid(), moved);
  if (!box) throw ConfigError("no voxel's centre lies in the box");
  return *box;
}

VoxelBox grown(const VoxelBox& box, std::int32_t margin) {
  return {{box.min.x - margin, box.min.y - margin, box.min.z - margin},
          {box.max.x + margin, box.max.y + margin, box.max.z + margin}};
}

void requireAffordable(const VoxelBox& box) {
  // Per axis first, so that the product cannot overflow.
  const std::int64_t longest =
      std::max({std::int64_t{box.max.x} - box.min.x, std::int64_t{box.max.y} - box.min.y,
                std::int64_t{box.max.z} - box.min.z});
  if (longest >= (1 << 20) || volume(box) > kMaxVoxels)
    throw ConfigError(
        "a distance field of this size, with what lies within the maximum distance around it, does "
        "not fit into memory; choose a smaller box or distance",
        {"box", "max-distance"});
}

/// Boxes that make up `box`, as large as they may be with `margin` around them. Each costs all of
/// its margin, so it is always the longest side that is halved.
void appendTiles(const VoxelBox& box, std::int32_t margin, std::vector<VoxelBox>& tiles) {
  const VoxelIndex size{box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z};
  const std::int32_t longest = std::max({size.x, size.y, size.z});
  if (volume(grown(box, margin)) <= kMaxTileVoxels || longest < margin) {
    tiles.push_back(box);
    return;
  }
  const auto axis = size.x == longest   ? &VoxelIndex::x
                    : size.y == longest ? &VoxelIndex::y
                                        : &VoxelIndex::z;
  VoxelBox first = box;
  VoxelBox second = box;
  first.max.*axis = box.min.*axis + longest / 2;
  second.min.*axis = first.max.*axis + 1;
  appendTiles(first, margin, tiles);
  appendTiles(second, margin, tiles);
}

}  // namespace

DistanceField::DistanceField(const VoxelSelection& voxels, double max_distance)
    : resolution_(voxels.resolution()), max_distance_(max_distance) {
  const double reach = std::ceil(max_distance / resolution_);
  if (!(max_distance > 0) || !(reach < 30000))
    throw ConfigError("the maximum distance must lie between 0 and 30,000 voxels");
  const VoxelSelection obstacles = voxels.withoutBox().withFreeVoxels(false);
  obstacles.requireResampledVoxels();
  VoxelFilter all;
  all.free_voxels = true;
  const VoxelSelection everything(voxels.map(), all, voxels.frame());
  box_ = computeBox(everything, voxels);
  const auto margin = static_cast<std::int32_t>(reach);
  const VoxelBox around = grown(box_, margin);
  requireAffordable(around);

  states_.resize(static_cast<std::size_t>(volume(box_)), VoxelState::Unknown);
  everything.forEachResampled([&](const VoxelIndex& v, const ExportedVoxel& voxel) {
    if (contains(box_, v))
      states_[offsetOf(v)] = voxel.class_id == kFreeClass ? VoxelState::Free : VoxelState::Occupied;
  });

  std::vector<VoxelIndex> occupied;
  obstacles.forEachResampled([&](const VoxelIndex& v, const ExportedVoxel&) {
    if (contains(around, v)) occupied.push_back(v);
  });
  distances_.resize(states_.size());
  std::vector<VoxelBox> tiles;
  appendTiles(box_, margin, tiles);
  for (const VoxelBox& tile : tiles) measure(tile, margin, occupied);
}

void DistanceField::measure(const VoxelBox& tile, std::int32_t margin,
                            const std::vector<VoxelIndex>& obstacles) {
  const VoxelBox around = grown(tile, margin);
  // A voxel more, so that what is exactly at the maximum distance is not cut off.
  DynamicEDT3D distances((margin + 1) * (margin + 1));
  distances.initializeEmpty(around.max.x - around.min.x + 1, around.max.y - around.min.y + 1,
                            around.max.z - around.min.z + 1);
  for (const VoxelIndex& v : obstacles) {
    if (contains(around, v))
      distances.occupyCell(v.x - around.min.x, v.y - around.min.y, v.z - around.min.z);
  }
  constexpr bool kSquaredOnly = false;
  distances.update(kSquaredOnly);

  VoxelIndex v;
  for (v.z = tile.min.z; v.z <= tile.max.z; ++v.z)
    for (v.y = tile.min.y; v.y <= tile.max.y; ++v.y)
      for (v.x = tile.min.x; v.x <= tile.max.x; ++v.x) {
        const double squared =
            distances.getSQCellDistance(v.x - around.min.x, v.y - around.min.y, v.z - around.min.z);
        distances_[offsetOf(v)] =
            static_cast<float>(std::min(max_distance_, std::sqrt(squared) * resolution_));
      }
}

std::array<int, 3> DistanceField::size() const {
  return {box_.max.x - box_.min.x + 1, box_.max.y - box_.min.y + 1, box_.max.z - box_.min.z + 1};
}

std::size_t DistanceField::offsetOf(const VoxelIndex& v) const {
  const auto [width, height, depth] = size();
  return (static_cast<std::size_t>(v.z - box_.min.z) * static_cast<std::size_t>(height) +
          static_cast<std::size_t>(v.y - box_.min.y)) *
             static_cast<std::size_t>(width) +
         static_cast<std::size_t>(v.x - box_.min.x);
}

void writeDistanceField(const DistanceField& field, const std::string& file) {
  const auto [width, height, depth] = field.size();
  const std::string shape = "(" + std::to_string(depth) + ", " + std::to_string(height) + ", " +
                            std::to_string(width) + ")";
  const VoxelBox& box = field.box();
  detail::NumpyArchive archive;
  detail::NumpyArray& distance = archive.add("distance", "<f4", shape);
  detail::NumpyArray& state = archive.add("state", "|u1", shape);
  VoxelIndex v;
  for (v.z = box.min.z; v.z <= box.max.z; ++v.z)
    for (v.y = box.min.y; v.y <= box.max.y; ++v.y)
      for (v.x = box.min.x; v.x <= box.max.x; ++v.x) {
        detail::writeBinary(distance, field.distance(v));
        detail::writeBinary(state, static_cast<std::uint8_t>(field.state(v)));
      }
  const Eigen::Vector3d first = Grid(field.resolution()).center(box.min);
  detail::writeBinary(archive.add("origin", "<f8", "(3,)"), first.x(), first.y(), first.z());
  detail::writeBinary(archive.add("resolution", "<f8", "()"), field.resolution());
  detail::writeBinary(archive.add("max_distance", "<f8", "()"), field.maxDistance());
  archive.write(file);
}

}  // namespace csom
