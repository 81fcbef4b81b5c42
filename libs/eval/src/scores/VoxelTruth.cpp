// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/VoxelTruth.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "world/VoxelBoxes.h"

namespace csom {

VoxelTruth::VoxelTruth(const SemanticMap& truth, double padding)
    : grid_(truth.grid()), classes_(truth.options().number_of_classes) {
  const auto known = truth.boundingBox();
  if (!known) throw std::invalid_argument("the truth is empty");
  truth.forEachVoxel([&](const VoxelIndex&, const DirichletVoxel& voxel) {
    if (voxel.state() == VoxelState::Free) knows_free_ = true;
  });
  box_ = knows_free_ ? *known : detail::padded(*known, padding, grid_);
  const std::size_t volume = detail::volume(box_);
  if (static_cast<double>(volume) > kMaxVoxels)
    throw std::invalid_argument("the box of the truth has " + std::to_string(volume) +
                                " voxels of " + toString(grid_.resolution()) +
                                " m; make it smaller or the voxels larger");
  voxels_.assign(volume, knows_free_ ? kLeftOut : kFreeClass);
  truth.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
    voxels_[indexOf(v)] =
        voxel.state() == VoxelState::Occupied ? voxel.mostLikelyClass() : kFreeClass;
  });
}

bool VoxelTruth::contains(const VoxelIndex& v) const {
  return box_.min.x <= v.x && v.x <= box_.max.x && box_.min.y <= v.y && v.y <= box_.max.y &&
         box_.min.z <= v.z && v.z <= box_.max.z;
}

std::size_t VoxelTruth::indexOf(const VoxelIndex& v) const {
  const auto offset = [](std::int32_t value, std::int32_t min) {
    return static_cast<std::size_t>(static_cast<std::int64_t>(value) - min);
  };
  return offset(v.x, box_.min.x) +
         detail::edge(box_.min.x, box_.max.x) *
             (offset(v.y, box_.min.y) +
              detail::edge(box_.min.y, box_.max.y) * offset(v.z, box_.min.z));
}

void VoxelTruth::leaveOut(const VoxelIndex& voxel) {
  if (contains(voxel)) voxels_[indexOf(voxel)] = kLeftOut;
}

void VoxelTruth::keepOnly(const SemanticMap& known) {
  std::vector<ClassId> kept(voxels_.size(), kLeftOut);
  known.forEachVoxelInBox(box_, [&](const VoxelIndex& v, const DirichletVoxel&) {
    kept[indexOf(v)] = voxels_[indexOf(v)];
  });
  voxels_ = std::move(kept);
}

std::optional<ClassId> VoxelTruth::at(const VoxelIndex& voxel) const {
  if (!contains(voxel)) return std::nullopt;
  const ClassId value = voxels_[indexOf(voxel)];
  return value == kLeftOut ? std::nullopt : std::optional<ClassId>(value);
}

}  // namespace csom
