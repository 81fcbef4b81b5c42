// SPDX-License-Identifier: BSD-3-Clause
// Robot poses on a lattice, so that the way a pose came cannot change the bits of a map.
#pragma once

#include <mrpt/poses/CPose3D.h>

#include <Eigen/Geometry>

namespace csom {

/// The pose with its translation rounded to 2⁻²⁰ m (about 1 µm) and its rotation to a quaternion of
/// components in steps of 2⁻³⁰ (about 2e-9 rad).
///
/// One and the same pose reaches a map by different ways: as a rotation matrix, as a quaternion, or
/// as yaw, pitch and roll of a text file. Each way leaves other last bits, and a point close to the
/// face of a voxel would fall on either side of it. The lattice is far coarser than those bits and
/// far finer than any sensor, so that all ways give the same map but for about one pose in a
/// million: two forms that straddle the middle between two lattice points are rounded apart.
///
/// Throws std::runtime_error if a component is not finite or the translation exceeds 2⁴² m.
Eigen::Isometry3d roundedPose(const mrpt::poses::CPose3D& pose);

/// robot ∘ sensor in double precision; `sensor` is used as it is (it is stored with the
/// observation, in one form only).
Eigen::Isometry3d sensorPoseInMap(const Eigen::Isometry3d& robot,
                                  const mrpt::poses::CPose3D& sensor);

}  // namespace csom
