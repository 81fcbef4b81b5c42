// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/CsomMapper.h>

namespace csom {

VoxelEstimate CsomMapper::at(const Eigen::Vector3d& center) const {
  const DirichletVoxel voxel = map_.at(center);
  if (!voxel.known()) return {};
  const bool occupied = voxel.state() == VoxelState::Occupied;
  return {true, voxel.occupancy(), occupied ? voxel.mostLikelyClass() : kFreeClass,
          voxel.probabilities(), voxel.surfaceClass()};
}

}  // namespace csom
