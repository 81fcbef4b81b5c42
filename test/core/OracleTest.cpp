// SPDX-License-Identifier: BSD-3-Clause
// The engine against the naive oracle, voxel by voxel and class by class.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/NaiveOracle.h"
#include "core/RandomScans.h"

namespace csom::test {
namespace {

class Oracle : public testing::TestWithParam<Method> {};

TEST_P(Oracle, AgreesWithinOneQuantum) {
  // The directions of surfaces, and differences of their sums, are found in single precision.
  const double of_voxel = GetParam() == Method::SurfaceCsom ? 5e-4 : 0;
  std::size_t compared = 0;
  std::size_t voxels = 0;
  std::size_t undecided = 0;
  int filled_cases = 0;
  for (int seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomCase random(static_cast<std::uint64_t>(seed));
    const Options options = random.options(GetParam());
    const Scan scan = random.scan(options, options.block_depth > 2 ? 40 : 120);
    SemanticMap map(options);
    map.insert(scan);
    NaiveOracle oracle(options);
    const auto expected = oracle.increments(scan);

    std::size_t known = 0;
    map.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
      ++known;
      ++voxels;
      if (oracle.isUndecided({v.x, v.y, v.z})) {
        ++undecided;
        return;
      }
      const auto found = expected.find({v.x, v.y, v.z});
      ASSERT_NE(found, expected.end()) << "voxel that the equations do not fill";
      const double sum = std::accumulate(found->second.begin(), found->second.end(), 0.0);
      for (int k = 0; k < options.number_of_classes; ++k) {
        const double mass = found->second[static_cast<std::size_t>(k)];
        // Two sources may fill one voxel (kernels and crossing beams), each rounded once; what is
        // bounded is rounded again.
        const bool bounded = options.free_space.mode == FreeSpace::Projective;
        const double roundings = (options.castsRays() && k == 0 ? 2 : 1) + (bounded ? 1 : 0);
        ASSERT_NEAR(voxel.evidence(static_cast<ClassId>(k)), mass,
                    roundings * kCountQuantum + 1e-5 * mass + of_voxel * sum)
            << "voxel " << v.x << ' ' << v.y << ' ' << v.z << " class " << k;
        ++compared;
      }
    });
    for (const auto& [cell, mass] : expected) {
      const double largest = *std::max_element(mass.begin(), mass.end());
      if (largest < 1.5 * kCountQuantum || oracle.isUndecided(cell)) continue;
      const VoxelIndex v{static_cast<std::int32_t>(cell[0]), static_cast<std::int32_t>(cell[1]),
                         static_cast<std::int32_t>(cell[2])};
      ASSERT_TRUE(map.voxel(v).known())
          << "voxel that the engine leaves out: " << v.x << ' ' << v.y << ' ' << v.z;
    }
    filled_cases += known > 0 ? 1 : 0;
  }
  EXPECT_GT(compared, 100000U);
  EXPECT_LT(undecided, voxels / 50);
  EXPECT_GT(filled_cases, kRandomCases * 9 / 10);
}

INSTANTIATE_TEST_SUITE_P(Methods, Oracle,
                         testing::Values(Method::SurfaceCsom, Method::SeeCsom, Method::SBki,
                                         Method::SCsm),
                         methodName);

TEST(OracleFarAway, AgreesEightyMetresFromTheSensor) {
  RandomCase random(7);
  Options options;
  options.resolution = 0.3;
  options.number_of_classes = 4;
  Scan scan;
  scan.origin = {1234.5, -4321.25, 10.125};
  for (int i = 0; i < 300; ++i) {
    scan.points.emplace_back(80.0F + static_cast<float>(random.real(-1, 1)),
                             static_cast<float>(random.real(-1, 1)), -1.5F);
    scan.labels.push_back(static_cast<ClassId>(random.integer(1, 3)));
  }
  SemanticMap map(options);
  map.insert(scan);
  const auto expected = NaiveOracle(options).increments(scan);
  map.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel&) {
    ASSERT_EQ(expected.count({v.x, v.y, v.z}), 1U) << "voxel that the equations do not fill";
  });
  for (const auto& [cell, mass] : expected) {
    const DirichletVoxel voxel =
        map.voxel({static_cast<std::int32_t>(cell[0]), static_cast<std::int32_t>(cell[1]),
                   static_cast<std::int32_t>(cell[2])});
    for (std::size_t k = 0; k < mass.size(); ++k)
      ASSERT_NEAR(voxel.evidence(static_cast<ClassId>(k)), mass[k], kCountQuantum + 1e-5 * mass[k]);
  }
}

TEST(OracleDensePoint, AMillionPointsAtOnePlaceSumUp) {
  Options options;
  options.number_of_classes = 2;
  options.resolution = 0.5;
  Scan scan;
  scan.points.assign(1000000, Eigen::Vector3f(0.25F, 0.25F, 0.25F));
  scan.labels.assign(scan.points.size(), 1);
  options.method = Method::SeeCsom;
  SemanticMap map(options);
  map.insert(scan);
  EXPECT_NEAR(map.voxel({0, 0, 0}).evidence(1), 1e6, 10.0);
}

TEST(OracleDensePoint, HitsAtOnePlaceAreTheirOwnNeighbours) {
  Options options;
  options.number_of_classes = 2;
  options.resolution = 0.5;
  Scan scan;
  scan.points.assign(10000, Eigen::Vector3f(0.25F, 0.25F, 0.25F));
  scan.labels.assign(scan.points.size(), 1);
  SemanticMap map(options);
  map.insert(scan);
  // The kernel of each is 1 at the centre of the voxel, and it lies in the voxel.
  EXPECT_NEAR(map.voxel({0, 0, 0}).evidence(1), 1e4 * (1 + options.surface.hit_weight), 10.0);
  EXPECT_EQ(map.voxel({0, 0, 0}).evidence(0), 0);
}

}  // namespace
}  // namespace csom::test
