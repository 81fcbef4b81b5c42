// SPDX-License-Identifier: BSD-3-Clause
// What must hold for scans of every kind: merging shards, moving and turning a scan.
#pragma once

#include <csom/core/SemanticMap.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "core/RandomScans.h"

namespace csom::test {

inline SemanticMap mapOf(const Options& options, const std::vector<Scan>& scans) {
  SemanticMap map(options);
  for (const Scan& scan : scans) map.insert(scan);
  return map;
}

/// Any split into three shards, merged in any order and any way, is the map of all scans.
inline void expectShardsToBeTheWhole(RandomCase& random, const Options& options,
                                     const std::vector<Scan>& scans) {
  const std::string expected = bytesOf(mapOf(options, scans));
  std::vector<SemanticMap> shards(3, SemanticMap(options));
  for (const Scan& scan : scans)
    shards[static_cast<std::size_t>(random.integer(0, 2))].insert(scan);
  std::shuffle(shards.begin(), shards.end(), random.engine());
  SemanticMap left = shards[0];
  left.merge(shards[1]);
  left.merge(shards[2]);
  ASSERT_EQ(bytesOf(left), expected);
  SemanticMap right = shards[1];
  right.merge(shards[2]);
  SemanticMap all = shards[0];
  all.merge(right);
  ASSERT_EQ(bytesOf(all), expected);
}

/// Every voxel of `a` has the counts of its image in `b`, and `b` has no others.
inline void expectMoved(const SemanticMap& a, const SemanticMap& b,
                        const std::function<VoxelIndex(const VoxelIndex&)>& imageOf) {
  ASSERT_EQ(a.knownVoxelCount(), b.knownVoxelCount());
  a.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
    const DirichletVoxel image = b.voxel(imageOf(v));
    for (int k = 0; k < a.options().number_of_classes; ++k)
      ASSERT_EQ(voxel.count(static_cast<ClassId>(k)), image.count(static_cast<ClassId>(k)))
          << v.x << ' ' << v.y << ' ' << v.z << " class " << k;
  });
}

/// A scan and the same one moved by up to 50 times so many voxels along each axis, in numbers that
/// binary fractions hold exactly: it is the same scan, bit for bit. Sets the resolution to go with.
inline void expectShiftToMoveTheMap(RandomCase& random, Options options, Scan scan, int voxels) {
  options.resolution = 0.25;
  scan.origin = (Eigen::Vector3d(random.real(-4, 4), random.real(-4, 4), random.real(-4, 4)) * 64)
                    .array()
                    .round() /
                64;
  for (Eigen::Vector3f& p : scan.points) p = (p * 1024.0F).array().round() / 1024.0F;
  const VoxelIndex shift{voxels * random.integer(-50, 50), voxels * random.integer(-50, 50),
                         voxels * random.integer(-50, 50)};
  Scan moved = scan;
  moved.origin += Eigen::Vector3d(shift.x, shift.y, shift.z) * options.resolution;
  expectMoved(mapOf(options, {scan}), mapOf(options, {moved}), [&](const VoxelIndex& v) {
    return VoxelIndex{v.x + shift.x, v.y + shift.y, v.z + shift.z};
  });
}

/// x' = −y, y' = x: voxel (i, j, k) becomes (−j−1, i, k).
inline Scan quarterTurned(const Scan& scan) {
  Scan turned = scan;
  turned.origin = {-scan.origin.y(), scan.origin.x(), scan.origin.z()};
  for (std::size_t i = 0; i < scan.points.size(); ++i)
    turned.points[i] = {-scan.points[i].y(), scan.points[i].x(), scan.points[i].z()};
  return turned;
}

}  // namespace csom::test
