// SPDX-License-Identifier: BSD-3-Clause
// The occupied voxels of a map as a points map of MRPT.
#include <csom/maps/OccupiedPoints.h>

namespace csom {
namespace {

std::unique_ptr<mrpt::maps::CSimplePointsMap> makePoints(const SemanticMap& map) {
  auto points = std::make_unique<mrpt::maps::CSimplePointsMap>();
  map.forEachVoxel([&](const VoxelIndex& index, const DirichletVoxel& voxel) {
    if (voxel.state() != VoxelState::Occupied) return;
    const Eigen::Vector3f center = map.grid().center(index).cast<float>();
    points->insertPointFast(center.x(), center.y(), center.z());
  });
  points->mark_as_modified();
  // MRPT computes these when first asked for, without a lock: now, while one thread has the map.
  points->boundingBox();
  points->getLargestDistanceFromOrigin();
  return points;
}

}  // namespace

OccupiedPoints& OccupiedPoints::operator=(const OccupiedPoints& other) {
  if (this != &other) invalidate();
  return *this;
}

const mrpt::maps::CSimplePointsMap& OccupiedPoints::get(const SemanticMap& map) const {
  const std::lock_guard lock(mutex_);
  if (!points_) points_ = makePoints(map);
  return *points_;
}

void OccupiedPoints::invalidate() {
  const std::lock_guard lock(mutex_);
  points_.reset();
}

}  // namespace csom
