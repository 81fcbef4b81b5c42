// SPDX-License-Identifier: BSD-3-Clause
// What must hold for every method: order, threads and shards do not matter; symmetry; subsets.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/MapProperties.h"
#include "core/RandomScans.h"

namespace csom::test {
namespace {

class Properties : public testing::TestWithParam<Method> {
 protected:
  /// Calls check(random, options, scans) for every random case.
  template <class Check>
  void forRandomCases(int scans_per_case, int max_points, Check&& check) {
    for (int seed = 0; seed < kRandomCases; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      RandomCase random(static_cast<std::uint64_t>(seed) + 1000);
      const Options options = random.options(GetParam());
      std::vector<Scan> scans;
      for (int i = 0; i < scans_per_case; ++i) scans.push_back(random.scan(options, max_points));
      check(random, options, scans);
      if (HasFatalFailure()) return;
    }
  }
  /// The filter may reject every block of a thin scan; most cases must hold something all the same.
  void countFilled(bool filled) { filled_cases_ += filled ? 1 : 0; }
  void expectMostlyFilled() const { EXPECT_GT(filled_cases_, kRandomCases * 9 / 10); }

 private:
  int filled_cases_ = 0;
};

TEST_P(Properties, OrderOfScansDoesNotMatter) {
  forRandomCases(4, 60,
                 [this](RandomCase& random, const Options& options, std::vector<Scan> scans) {
                   const std::string expected = bytesOf(mapOf(options, scans));
                   countFilled(!expected.empty());
                   std::shuffle(scans.begin(), scans.end(), random.engine());
                   ASSERT_EQ(bytesOf(mapOf(options, scans)), expected);
                 });
  expectMostlyFilled();
}

TEST_P(Properties, NumberOfThreadsDoesNotMatter) {
  forRandomCases(2, 80, [](RandomCase&, Options options, const std::vector<Scan>& scans) {
    const std::string expected = bytesOf(mapOf(options, scans));
    for (const int threads : {2, 4}) {
      options.threads = threads;
      ASSERT_EQ(bytesOf(mapOf(options, scans)), expected) << threads << " threads";
    }
  });
}

TEST_P(Properties, NumberOfThreadsDoesNotMatterForAWideScan) {
  // Hundreds of chunks, so that the work is really divided.
  for (const FreeSpace free_space :
       {FreeSpace::None, FreeSpace::Sampled, FreeSpace::Raycast, FreeSpace::Projective}) {
    RandomCase random(99);
    Options options;
    options.method = GetParam();
    options.number_of_classes = 5;
    options.free_space.mode = free_space;
    options.free_space.resolution = 2;
    Scan scan;
    for (int i = 0; i < 4000; ++i) {
      scan.points.push_back(
          Eigen::Vector3d(random.real(-15, 15), random.real(-15, 15), random.real(-2, 2))
              .cast<float>());
      scan.labels.push_back(static_cast<ClassId>(random.integer(1, 4)));
    }
    const SemanticMap one = mapOf(options, {scan});
    ASSERT_GT(one.chunks().chunkCount(), 200U);
    for (const int threads : {2, 4}) {
      options.threads = threads;
      ASSERT_EQ(bytesOf(mapOf(options, {scan})), bytesOf(one)) << threads << " threads";
    }
  }
}

TEST_P(Properties, ShardsMergedInAnyOrderAreTheWhole) {
  forRandomCases(6, 40, expectShardsToBeTheWhole);
}

TEST_P(Properties, ShiftByWholeBlocksMovesTheMap) {
  forRandomCases(
      1, 80, [this](RandomCase& random, Options options, const std::vector<Scan>& scans) {
        options.scan.ds_resolution = random.oneOf<double>({0, 0.125, 0.25});
        countFilled(!mapOf(options, scans).empty());
        const int block = options.method == Method::SCsm ? 1 : 1 << (options.block_depth - 1);
        expectShiftToMoveTheMap(random, options, scans[0], block);
      });
  expectMostlyFilled();
}

TEST_P(Properties, QuarterTurnTurnsTheMap) {
  // Sums run in another order: one quantum.
  forRandomCases(1, 80, [this](RandomCase& random, Options options, std::vector<Scan> scans) {
    options.scan.ds_resolution = 0;
    Scan scan = scans[0];
    scan.origin = {random.real(-4, 4), random.real(-4, 4), random.real(-4, 4)};
    const SemanticMap a = mapOf(options, {scan});
    const SemanticMap b = mapOf(options, {quarterTurned(scan)});
    countFilled(!a.empty());
    // Both ways, so that neither map may hold a voxel that the other lacks.
    b.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
      const DirichletVoxel image = a.voxel({v.y, -v.x - 1, v.z});
      ASSERT_NEAR(voxel.evidence(), image.evidence(),
                  options.number_of_classes * 1.01 * kCountQuantum + 1e-5 * voxel.evidence());
    });
    a.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
      const DirichletVoxel image = b.voxel({-v.y - 1, v.x, v.z});
      for (int k = 0; k < options.number_of_classes; ++k) {
        const double mass = voxel.evidence(static_cast<ClassId>(k));
        ASSERT_NEAR(mass, image.evidence(static_cast<ClassId>(k)),
                    1.01 * kCountQuantum + 1e-5 * mass);
      }
    });
  });
  expectMostlyFilled();
}

TEST_P(Properties, ProjectiveFreeSpaceWithoutAnImageIsThatOfRays) {
  forRandomCases(1, 80, [this](RandomCase&, Options options, const std::vector<Scan>& scans) {
    options.free_space.mode = FreeSpace::Raycast;
    const SemanticMap rays = mapOf(options, scans);
    countFilled(!rays.empty());
    options.free_space.mode = FreeSpace::Projective;
    const SemanticMap map = mapOf(options, scans);
    if (!options.usesImages()) {
      ASSERT_TRUE(bytesOf(map) == bytesOf(rays));
      return;
    }
    // With a method that bounds its words: of the same voxels, 1 of surfaces and 0.4 of rays a
    // scan.
    map.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
      ASSERT_TRUE(rays.voxel(v).known());
      double all = 0;
      for (int k = 0; k < options.number_of_classes; ++k)
        all += voxel.evidence(static_cast<ClassId>(k));
      ASSERT_LE(all, 1.41 * static_cast<double>(scans.size()));
    });
  });
  expectMostlyFilled();
}

/// Without down-sampling, a hit's surface ends nearer than this [m].
double longestSurface(const Options& options) {
  const double spacing = std::max(1.1, options.surface.gap);
  return options.resolution *
         (options.surface.reach * spacing + options.surface.thickness * std::sqrt(3.0) / 2);
}

TEST_P(Properties, ProbabilitiesSumToOneAndOccupiedVoxelsHaveAPointNearby) {
  forRandomCases(1, 60, [](RandomCase&, Options options, const std::vector<Scan>& scans) {
    options.scan.ds_resolution = 0;
    const SemanticMap map = mapOf(options, scans);
    const double reach = options.method == Method::SCsm          ? options.resolution
                         : options.method == Method::SurfaceCsom ? longestSurface(options)
                         : options.usesClassEntropy()            ? options.kernelLengthMax()
                                                                 : options.kernelLengthFixed();
    map.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
      const std::vector<double> lambda = voxel.probabilities();
      ASSERT_NEAR(std::accumulate(lambda.begin(), lambda.end(), 0.0), 1.0, 1e-12);
      for (std::size_t k = 0; k < lambda.size(); ++k)
        ASSERT_DOUBLE_EQ(lambda[k], voxel.probability(static_cast<ClassId>(k)));
      ASSERT_GE(voxel.entropy(), 0.0);
      ASSERT_LE(voxel.entropy(), 1.0 + 1e-12);
      if (voxel.state() != VoxelState::Occupied) return;
      const bool near = std::any_of(
          scans[0].points.begin(), scans[0].points.end(), [&](const Eigen::Vector3f& p) {
            return (scans[0].origin + p.cast<double>() - map.grid().center(v)).norm() <
                   reach * 1.0001;
          });
      ASSERT_TRUE(near);
    });
  });
}

INSTANTIATE_TEST_SUITE_P(Methods, Properties,
                         testing::Values(Method::SurfaceCsom, Method::SeeCsom, Method::SBki,
                                         Method::SCsm),
                         methodName);

TEST(RedundantVoxelFilter, FillsASubset) {
  std::size_t filtered = 0;
  for (int seed = 0; seed < kRandomCases; ++seed) {
    RandomCase random(static_cast<std::uint64_t>(seed) + 5000);
    Options on = random.options(Method::SeeCsom);
    on.see_csom.rvfm = true;
    // A crossed voxel is known with or without the filter: leave beams out of the comparison.
    if (on.castsRays()) on.free_space.mode = FreeSpace::None;
    Options off = on;
    off.see_csom.rvfm = false;
    const Scan scan = random.scan(on, 100);
    SemanticMap with(on);
    SemanticMap without(off);
    with.insert(scan);
    without.insert(scan);
    with.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
      const DirichletVoxel other = without.voxel(v);
      for (int k = 0; k < on.number_of_classes; ++k)
        ASSERT_EQ(voxel.count(static_cast<ClassId>(k)), other.count(static_cast<ClassId>(k)))
            << "seed " << seed;
    });
    filtered += without.knownVoxelCount() - with.knownVoxelCount();
  }
  EXPECT_GT(filtered, 0U);
}

}  // namespace
}  // namespace csom::test
