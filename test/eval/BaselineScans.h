// SPDX-License-Identifier: BSD-3-Clause
// Inputs that the tests of the compared methods share.
#pragma once

#include <csom/core/Options.h>
#include <csom/core/types.h>
#include <csom/eval/Mapper.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace csom::test {

inline Options baselineInput(FreeSpace free_space) {
  Options input;
  input.number_of_classes = 5;
  input.resolution = 0.1;
  input.free_space.mode = free_space;
  input.free_space.resolution = 0.3;
  return input;
}

/// A point of a class, as seen from a sensor at the origin.
inline Scan scanOf(const Eigen::Vector3f& point, ClassId label = 1) {
  Scan scan;
  scan.points = {point};
  scan.labels = {label};
  return scan;
}

/// Points in [-1, 1]³ as seen from somewhere therein, each of one of classes 1 to 4.
inline Scan randomScan(std::uint64_t seed, int points) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto anywhere = [&] {
    const double x = coordinate(random);
    const double y = coordinate(random);
    return Eigen::Vector3d(x, y, coordinate(random));
  };
  Scan scan;
  scan.origin = anywhere();
  for (int i = 0; i < points; ++i) {
    scan.points.push_back((anywhere() - scan.origin).cast<float>());
    scan.labels.push_back(static_cast<ClassId>(1 + i % 4));
  }
  return scan;
}

inline std::vector<Eigen::Vector3d> hitsOf(const Scan& scan) {
  std::vector<Eigen::Vector3d> hits;
  for (const Eigen::Vector3f& point : scan.points)
    hits.push_back(scan.origin + point.cast<double>());
  return hits;
}

/// Points every `step` along each beam, the last one that far before the hit.
inline std::vector<Eigen::Vector3d> freeSamplesOf(const Scan& scan, double step) {
  std::vector<Eigen::Vector3d> samples;
  for (const Eigen::Vector3d& hit : hitsOf(scan)) {
    const Eigen::Vector3d beam = hit - scan.origin;
    for (int n = 1; n * step < beam.norm(); ++n)
      samples.push_back(hit - n * step * beam.normalized());
  }
  return samples;
}

/// Calls `visit` with the centre of each voxel of edge 0.1 m in [-half_side, half_side]³.
template <class Visitor>
void forEachCenter(double half_side, Visitor&& visit) {
  const int n = static_cast<int>(std::lround(half_side / 0.1));
  for (int z = -n; z < n; ++z)
    for (int y = -n; y < n; ++y)
      for (int x = -n; x < n; ++x)
        visit(Eigen::Vector3d(0.1 * (x + 0.5), 0.1 * (y + 0.5), 0.1 * (z + 0.5)));
}

/// The sparse kernel of Melkumyan and Ramos in closed form.
inline double sparseKernelInClosedForm(double t) {
  if (t >= 1) return 0;
  const double turn = 2 * M_PI * t;
  return (2 + std::cos(turn)) / 3 * (1 - t) + std::sin(turn) / (2 * M_PI);
}

/// What holds for each method on each input.
inline void expectPlainEstimate(const VoxelEstimate& voxel) {
  ASSERT_EQ(voxel.probabilities.size(), voxel.known ? 2U : 0U);
  if (!voxel.known) {
    EXPECT_EQ(voxel.occupancy, 0.5);
    EXPECT_EQ(voxel.class_id, kFreeClass);
    return;
  }
  EXPECT_GE(voxel.occupancy, 0);
  EXPECT_LE(voxel.occupancy, 1);
  EXPECT_EQ(voxel.probabilities[1], voxel.occupancy);
  EXPECT_DOUBLE_EQ(voxel.probabilities[0] + voxel.probabilities[1], 1);
}

}  // namespace csom::test
