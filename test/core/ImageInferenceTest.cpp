// SPDX-License-Identifier: BSD-3-Clause
// Scans with an image: against the naive oracle, bit by bit, and what must hold for them.
#include <csom/core/SemanticMap.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/MapProperties.h"
#include "core/NaiveImageOracle.h"
#include "core/RandomImages.h"

namespace csom::test {
namespace {

TEST(ImageOracle, AgreesInEveryBit) {
  std::size_t occupied = 0;
  std::size_t facets = 0;
  std::size_t free = 0;
  for (int seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomImage random(static_cast<std::uint64_t>(seed));
    const Options options = random.imageOptions();
    const Scan scan = random.image(options);
    if (scan.points.empty()) continue;
    SemanticMap map(options);
    const ScanReport report = map.insert(scan);
    const NaiveImageOracle oracle(options, scan);
    std::size_t known = 0;
    map.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
      ++known;
      const auto found = oracle.increments().find({v.x, v.y, v.z});
      ASSERT_NE(found, oracle.increments().end())
          << "voxel that the definitions leave out: " << v.x << ' ' << v.y << ' ' << v.z
          << " class " << voxel.classAt(0) << " count " << voxel.countAt(0);
      for (int k = 0; k < options.number_of_classes; ++k) {
        const auto of_class = found->second.find(static_cast<ClassId>(k));
        ASSERT_EQ(voxel.count(static_cast<ClassId>(k)),
                  of_class == found->second.end() ? 0 : of_class->second)
            << "voxel " << v.x << ' ' << v.y << ' ' << v.z << " class " << k;
      }
    });
    if (HasFatalFailure()) return;
    ASSERT_EQ(known, oracle.increments().size());
    ASSERT_EQ(report.free_voxels, oracle.freeVoxels());
    ASSERT_EQ(report.voxels_updated, known - oracle.freeVoxels());
    occupied += report.voxels_updated;
    facets += oracle.facetVoxels();
    free += report.free_voxels;
  }
  EXPECT_GT(occupied, 20000U);
  EXPECT_GT(facets, 10000U);
  EXPECT_GT(free, 10000U);
}

/// Calls check(random, options, scans) for every random case.
template <class Check>
void forRandomCases(int scans_per_case, const Check& check) {
  for (int seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomImage random(static_cast<std::uint64_t>(seed) + 1000);
    const Options options = random.imageOptions();
    std::vector<Scan> scans;
    for (int i = 0; i < scans_per_case; ++i) scans.push_back(random.image(options, 16, 90));
    check(random, options, scans);
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(ImageProperties, OrderOfScansDoesNotMatter) {
  forRandomCases(4, [](RandomImage& random, const Options& options, std::vector<Scan> scans) {
    const std::string expected = bytesOf(mapOf(options, scans));
    ASSERT_FALSE(expected.empty());
    std::shuffle(scans.begin(), scans.end(), random.engine());
    ASSERT_EQ(bytesOf(mapOf(options, scans)), expected);
  });
}

TEST(ImageProperties, OrderOfPointsDoesNotMatter) {
  forRandomCases(1, [](RandomImage& random, const Options& options, std::vector<Scan> scans) {
    Scan& scan = scans[0];
    // Where two points name a pixel the first one has it: leave one of them.
    for (std::size_t i = 0; i < scan.points.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (scan.image.pixels[i] == scan.image.pixels[j])
          scan.image.pixels[i].row = RangeImage::kNoRow;
    Scan shuffled = scan;
    std::vector<std::size_t> order(scan.points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), random.engine());
    const auto classes = static_cast<std::size_t>(options.number_of_classes);
    for (std::size_t i = 0; i < order.size(); ++i) {
      shuffled.points[i] = scan.points[order[i]];
      shuffled.image.pixels[i] = scan.image.pixels[order[i]];
      if (!scan.isSoft()) {
        shuffled.labels[i] = scan.labels[order[i]];
        continue;
      }
      for (std::size_t k = 0; k < classes; ++k)
        shuffled.scores[i * classes + k] = scan.scores[order[i] * classes + k];
    }
    ASSERT_EQ(bytesOf(mapOf(options, {shuffled})), bytesOf(mapOf(options, {scan})));
  });
}

TEST(ImageProperties, NumberOfThreadsDoesNotMatter) {
  std::size_t large = 0;
  forRandomCases(1, [&](RandomImage& random, Options options, std::vector<Scan> scans) {
    if (random.integer(0, 9) == 0) {  // large enough to be cut into parts
      scans.push_back(random.image(options, 64, 400));
      large += scans.back().points.size() > 10000 ? 1 : 0;
    }
    const std::string expected = bytesOf(mapOf(options, scans));
    for (const int threads : {2, 4}) {
      options.threads = threads;
      ASSERT_EQ(bytesOf(mapOf(options, scans)), expected) << threads << " threads";
    }
  });
  EXPECT_GT(large, 2U);
}

TEST(ImageProperties, ShardsMergedInAnyOrderAreTheWhole) {
  forRandomCases(6, expectShardsToBeTheWhole);
}

TEST(ImageProperties, ShiftByWholeChunksMovesTheMap) {
  forRandomCases(1,
                 [](RandomImage& random, const Options& options, const std::vector<Scan>& scans) {
                   ASSERT_FALSE(mapOf(options, scans).empty());
                   expectShiftToMoveTheMap(random, options, scans[0], kChunkSide);
                 });
}

TEST(ImageProperties, QuarterTurnTurnsTheMap) {
  // To the last bit.
  forRandomCases(1, [](RandomImage&, const Options& options, const std::vector<Scan>& scans) {
    const SemanticMap map = mapOf(options, {scans[0]});
    ASSERT_FALSE(map.empty());
    expectMoved(map, mapOf(options, {quarterTurned(scans[0])}), [](const VoxelIndex& v) {
      return VoxelIndex{-v.y - 1, v.x, v.z};
    });
  });
}

TEST(ImageProperties, FreeSpaceOfTheImageAgreesWithThatOfRays) {
  // Both have the same surfaces. What the image makes free is what rays cross, or lies between two.
  std::size_t crossed = 0;
  std::size_t between = 0;
  forRandomCases(1, [&](RandomImage&, Options options, std::vector<Scan> scans) {
    options.free_space.mode = FreeSpace::Projective;
    const SemanticMap map = mapOf(options, scans);
    options.free_space.mode = FreeSpace::Raycast;
    const SemanticMap rays = mapOf(options, scans);
    const auto isSurface = [](const DirichletVoxel& voxel) {
      return voxel.known() && voxel.classAt(voxel.size() - 1) != kFreeClass;
    };
    map.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
      const DirichletVoxel reference = rays.voxel(v);
      ASSERT_EQ(isSurface(voxel), isSurface(reference));
      if (isSurface(voxel)) {
        for (int k = 0; k < options.number_of_classes; ++k)
          ASSERT_EQ(voxel.count(static_cast<ClassId>(k)), reference.count(static_cast<ClassId>(k)));
      } else {
        (reference.known() ? crossed : between) += 1;
      }
    });
  });
  EXPECT_GT(crossed, 5000U);
  EXPECT_GT(between, 500U);
}

/// What a sensor at `origin` sees of ground at z = −0.1, the middle of a voxel, and of a wall at x
/// = 10, from 20° below the horizon up to 10° above it; of a person in front of it as well, a slab
/// at x = 5 up to a height of 2 m.
Scan scanOfStreet(const Eigen::Vector3d& origin, bool person) {
  constexpr double kDegree = 3.14159265358979323846 / 180;
  Scan scan;
  scan.origin = origin;
  scan.image.column_step = 1;
  for (std::uint16_t row = 0; row < 16; ++row)
    for (std::int32_t column = 0; column <= 80; ++column) {
      const double elevation = (2 * row - 20) * kDegree;
      const double azimuth = 0.5 * (column - 40) * kDegree;
      const Eigen::Vector3d beam(std::cos(elevation) * std::cos(azimuth),
                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      double range = (10 - origin.x()) / beam.x();
      ClassId label = 2;
      const double to_ground = -(origin.z() + 0.1) / beam.z();
      if (elevation < 0 && to_ground < range) {
        range = to_ground;
        label = 1;
      }
      const double to_person = (5 - origin.x()) / beam.x();
      const Eigen::Vector3d there = origin + to_person * beam;
      if (person && to_person < range && std::abs(there.y()) < 0.6 && there.z() < 2) {
        range = to_person;
        label = 3;
      }
      scan.points.push_back((range * beam).cast<float>());
      scan.labels.push_back(label);
      scan.image.pixels.push_back({row, column});
    }
  return scan;
}

Options optionsOfStreet() {
  Options options;
  options.number_of_classes = 4;
  options.resolution = 0.2;
  options.free_space.mode = FreeSpace::Projective;
  return options;
}

/// The voxels of the hits of a class.
std::vector<VoxelIndex> voxelsOf(const SemanticMap& map, const Scan& scan, ClassId label) {
  std::vector<VoxelIndex> voxels;
  for (std::size_t i = 0; i < scan.points.size(); ++i)
    if (scan.labels[i] == label)
      voxels.push_back(map.grid().voxelAt(scan.origin + scan.points[i].cast<double>()));
  return voxels;
}

TEST(ImageProperties, WhoHasLeftLeavesAlsoWhereTheImageEnds) {
  // The uppermost beams hit the person, so that half of those voxels lies beyond the image.
  SemanticMap map(optionsOfStreet());
  const Scan with_person = scanOfStreet({0, 0, 1.1}, true);
  for (int i = 0; i < 5; ++i) map.insert(with_person);
  const std::vector<VoxelIndex> person = voxelsOf(map, with_person, 3);
  ASSERT_GT(person.size(), 100U);
  for (const VoxelIndex& v : person) EXPECT_EQ(map.voxel(v).state(), VoxelState::Occupied);
  for (int i = 0; i < 20; ++i) map.insert(scanOfStreet({0, 0, 1.1}, false));
  for (const VoxelIndex& v : person)
    EXPECT_EQ(map.voxel(v).state(), VoxelState::Free) << v.x << ' ' << v.y << ' ' << v.z;
}

TEST(ImageProperties, GroundStaysThatTheLowestBeamsHaveLeftBehind) {
  // The sensor comes nearer: what its lowest beams hit lies below them in the next scans, partly
  // beside and partly in front of what they hit then.
  SemanticMap map(optionsOfStreet());
  std::vector<VoxelIndex> ground;
  for (int i = 0; i < 30; ++i) {
    const Scan scan = scanOfStreet({0.1 * i, 0, 1.1}, false);
    map.insert(scan);
    for (const VoxelIndex& v : voxelsOf(map, scan, 1)) ground.push_back(v);
  }
  ASSERT_GT(ground.size(), 5000U);
  std::size_t lost = 0;
  for (const VoxelIndex& v : ground) lost += map.voxel(v).state() != VoxelState::Occupied ? 1 : 0;
  EXPECT_EQ(lost, 0U);
}

TEST(ImageProperties, AbsurdImagesAreMapsAllTheSame) {
  for (int seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomImage random(static_cast<std::uint64_t>(seed) + 3000);
    Options options;
    options.number_of_classes = 4;
    options.free_space.mode = random.oneOf<FreeSpace>(
        {FreeSpace::None, FreeSpace::Projective, FreeSpace::Raycast, FreeSpace::Sampled});
    options.free_space.resolution = 50;
    Scan scan;
    scan.image.columns_of_turn = random.integer(0, 1) * std::numeric_limits<std::int32_t>::max();
    scan.image.column_step =
        random.oneOf<std::int32_t>({1, 7, std::numeric_limits<std::int32_t>::max()});
    const auto coordinate = [&] {
      return random.oneOf<float>({0, -0.0F, 1e-38F, 1e-6F, -1e-3F, 0.1F, 0.1F, -1, 3, 30, -1000,
                                  1e6F, 1e30F, std::numeric_limits<float>::infinity(),
                                  std::nanf("")});
    };
    for (int i = random.integer(0, 200); i > 0; --i) {
      scan.points.emplace_back(coordinate(), coordinate(), coordinate());
      scan.labels.push_back(static_cast<ClassId>(random.integer(0, 4)));
      const std::int32_t column = random.oneOf<std::int32_t>(
          {0, 1, 2, 3, 1000, std::numeric_limits<std::int32_t>::max() - 1});
      const bool closed = scan.image.columns_of_turn > 0;
      scan.image.pixels.push_back({random.oneOf<std::uint16_t>({0, 1, 2, 3, 65534, 65535}),
                                   closed || random.integer(0, 1) == 0 ? column : -column - 2});
    }
    SemanticMap map(options);
    const ScanReport report = map.insert(scan);
    EXPECT_EQ(report.points, scan.points.size());
    EXPECT_EQ(report.rejectedTotal() + report.training_points, report.points);
    map.forEachVoxel([&](const VoxelIndex&, const DirichletVoxel& voxel) {
      const std::vector<double> lambda = voxel.probabilities();
      ASSERT_NEAR(std::accumulate(lambda.begin(), lambda.end(), 0.0), 1.0, 1e-12);
    });
    options.threads = 2;
    EXPECT_EQ(bytesOf(mapOf(options, {scan})), bytesOf(map));
  }
}

}  // namespace
}  // namespace csom::test
