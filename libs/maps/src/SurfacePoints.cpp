// SPDX-License-Identifier: BSD-3-Clause
// The surfaces of a map as points to match others with.
#include <csom/maps/SurfacePoints.h>

#include <Eigen/Eigenvalues>

namespace csom {
namespace {

/// A surface is flat if the evidence spreads across it by less than this share of its spread along
/// it (variances).
constexpr double kFlat = 0.75;

double occupiedEvidence(const DirichletVoxel& voxel) {
  return voxel.state() == VoxelState::Occupied ? voxel.evidence() - voxel.evidence(kFreeClass) : 0;
}

/// The plane of the evidence around a voxel.
struct Plane {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;  ///< zero where there is no plane
};

Plane planeAround(const SemanticMap& map, const VoxelIndex& index) {
  double weights = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (std::int32_t z = -1; z <= 1; ++z)
    for (std::int32_t y = -1; y <= 1; ++y)
      for (std::int32_t x = -1; x <= 1; ++x) {
        const double weight = occupiedEvidence(map.voxel({index.x + x, index.y + y, index.z + z}));
        if (weight == 0) continue;
        const Eigen::Vector3d at(x, y, z);
        weights += weight;
        sum += weight * at;
        squares += weight * at * at.transpose();
      }
  const Eigen::Vector3d mean = sum / weights;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.computeDirect(squares / weights - mean * mean.transpose());
  const Eigen::Vector3d& variances = axes.eigenvalues();
  const Eigen::Vector3d point = map.grid().center(index) + map.grid().resolution() * mean;
  // NaN, too, is no plane.
  if (!(variances[0] < kFlat * variances[1])) return {point, Eigen::Vector3d::Zero()};
  return {point, axes.eigenvectors().col(0)};
}

/// From the centre of a voxel along normals to where the evidence is on both sides.
Eigen::Vector3d surfacePoint(const SemanticMap& map, const VoxelIndex& index) {
  constexpr int kMaxSteps = 4;
  Eigen::Vector3d point = map.grid().center(index);
  VoxelIndex here = index;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Plane plane = planeAround(map, here);
    point += plane.normal * plane.normal.dot(plane.point - point);
    const VoxelIndex next = map.grid().voxelAt(point);
    if (next == here || map.voxel(next).state() != VoxelState::Occupied) break;
    here = next;
  }
  return point;
}

}  // namespace

std::unique_ptr<const SurfacePoints> makeSurfacePoints(const SemanticMap& map) {
  auto out = std::make_unique<SurfacePoints>();
  map.forEachVoxel([&](const VoxelIndex& index, const DirichletVoxel& voxel) {
    if (voxel.state() != VoxelState::Occupied) return;
    const Eigen::Vector3f point = surfacePoint(map, index).cast<float>();
    out->points.insertPointFast(point.x(), point.y(), point.z());
    out->classes.push_back(voxel.mostLikelyClass());
  });
  out->points.mark_as_modified();
  // MRPT computes these when first asked for, without a lock: now, while one thread has the map.
  out->points.boundingBox();
  out->points.getLargestDistanceFromOrigin();
  return out;
}

SurfacePointsCache& SurfacePointsCache::operator=(const SurfacePointsCache& other) {
  if (this != &other) invalidate();
  return *this;
}

const SurfacePoints& SurfacePointsCache::get(const SemanticMap& map) const {
  const std::lock_guard lock(mutex_);
  if (!points_) points_ = makeSurfacePoints(map);
  return *points_;
}

void SurfacePointsCache::invalidate() {
  const std::lock_guard lock(mutex_);
  points_.reset();
}

}  // namespace csom
