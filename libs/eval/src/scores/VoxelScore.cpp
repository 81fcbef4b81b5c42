// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/VoxelScore.h>

#include <stdexcept>

#include "world/VoxelBoxes.h"

namespace csom {

namespace {

ClassId classOf(const DirichletVoxel& voxel) {
  return voxel.state() == VoxelState::Occupied ? voxel.mostLikelyClass() : kFreeClass;
}

}  // namespace

VoxelScore::VoxelScore(const SemanticMap& map, const SemanticMap& truth, double padding)
    : matrix_(truth.options().number_of_classes) {
  if (map.options().resolution != truth.options().resolution ||
      map.options().number_of_classes != truth.options().number_of_classes)
    throw std::invalid_argument("map and truth cannot be compared: resolution " +
                                toString(map.options().resolution) + " against " +
                                toString(truth.options().resolution) + " m, " +
                                toString(map.options().number_of_classes) + " against " +
                                toString(truth.options().number_of_classes) + " classes");
  const auto known = truth.boundingBox();
  if (!known) throw std::invalid_argument("the truth is empty");

  std::size_t free_voxels = 0;
  truth.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
    if (voxel.state() == VoxelState::Free) ++free_voxels;
    matrix_.add(classOf(voxel), classOf(map.voxel(v)));
  });
  if (free_voxels > 0) return;
  // What neither map knows is not listed: such voxels are counted all at once.
  const VoxelBox box = detail::padded(*known, padding, truth.grid());
  map.forEachVoxelInBox(box, [&](const VoxelIndex& v, const DirichletVoxel& voxel) {
    if (voxel.state() == VoxelState::Occupied && !truth.voxel(v).known())
      matrix_.add(kFreeClass, voxel.mostLikelyClass());
  });
  matrix_.add(kFreeClass, kFreeClass, detail::volume(box) - matrix_.total());
}

double VoxelScore::accuratenessOccupied() const {
  const std::size_t free_in_both = matrix_.count(kFreeClass, kFreeClass);
  const std::size_t either = matrix_.total() - free_in_both;
  return either == 0
             ? 0.0
             : static_cast<double>(matrix_.correct() - free_in_both) / static_cast<double>(either);
}

}  // namespace csom
