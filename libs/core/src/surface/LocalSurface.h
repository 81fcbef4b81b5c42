// SPDX-License-Identifier: BSD-3-Clause
// The surface around each hit of a scan, and the kernel that follows from it (surface-csom).
#pragma once

#include <csom/core/Options.h>
#include <csom/core/ScanPreparation.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

namespace csom::detail {

/// What the neighbourhood of a training point looks like. Lengths in voxels.
///
/// From the nearest `neighbours` hits q_n of a hit p, weighted by k(‖q_n − p‖/2.5s):
/// eigenvalues λ0 ≤ λ1 ≤ λ2 of their covariance, the normal n, and the spacing
///
///     s = d_3·√(π/3.5),  d_3 the distance to the third nearest hit                       (S1)
///
/// since a disc of radius d_3 holds 3.5 hits if each stands for an area s². A hit lies on a plane
/// if λ0 < λ1/2, otherwise it is scattered.
struct LocalSurface {
  enum class Shape : std::uint8_t { Free, Scattered, Plane };

  Shape shape = Shape::Scattered;
  /// L of the point's kernel: `reach`·s, s no less than 1.1 voxels and no more than
  /// max(ds, r), or `gap` times that on a plane that its hits cover to both sides; 0.85 of
  /// it for a scattered hit. L_min of eq. (15) for a free sample.
  float length = 0;
  /// min(1, (1.3·max(ds, r)/s)²): how much it says that no other hit is near.
  float density = 0;
  /// n of a plane; unit length, towards the centre c of the voxel that the hit lies in.
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  /// A plane passes through a voxel with the centre v if −h ≤ n·(v − p) ≤ max(h, n·(c − p)), with
  /// h = `thickness`·(|n_x|+|n_y|+|n_z|)/2; 0 for all others. So a plane on the border of
  /// two voxels passes through that with the hit.
  float half_thickness = 0;
  float half_thickness_of_own_side = 0;  ///< max(h, n·(c − p))

  /// All voxels that a hit votes for have their centres nearer than this, its own included.
  float reach() const { return std::max(length + half_thickness_of_own_side, kHalfVoxelDiagonal); }

  static constexpr float kHalfVoxelDiagonal = 0.87F;  ///< rounded up
};

/// One a training point. Depends on nothing but the scan and the options.
std::vector<LocalSurface> computeLocalSurfaces(const PreparedScan& scan, const Options& options);

}  // namespace csom::detail
