// SPDX-License-Identifier: BSD-3-Clause
#include <csom/exports/VoxelSelection.h>

#include <array>
#include <cmath>
#include <map>
#include <random>

#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using Voxels = std::map<std::array<std::int32_t, 3>, ClassId>;

Voxels selected(const VoxelSelection& selection) {
  Voxels voxels;
  selection.forEach([&](const VoxelIndex& i, const ExportedVoxel& v) {
    EXPECT_TRUE(voxels.emplace(std::array{i.x, i.y, i.z}, v.class_id).second);
  });
  EXPECT_EQ(selection.count(), voxels.size());
  return voxels;
}

Voxels resampled(const VoxelSelection& selection) {
  Voxels voxels;
  const Grid& grid = selection.map().grid();
  selection.forEachResampled([&](const VoxelIndex& i, const ExportedVoxel& v) {
    EXPECT_TRUE(voxels.emplace(std::array{i.x, i.y, i.z}, v.class_id).second) << "twice";
    EXPECT_EQ(v.center, grid.center(i));
  });
  return voxels;
}

/// What a filter must take, by the definition of each condition.
template <class Condition>
Voxels voxelsThat(const SemanticMap& map, Condition&& holds) {
  Voxels voxels;
  map.forEachVoxel([&](const VoxelIndex& i, const DirichletVoxel& v) {
    if (holds(map.grid().center(i), v))
      voxels.emplace(std::array{i.x, i.y, i.z}, v.mostLikelyClass());
  });
  return voxels;
}

class VoxelSelectionTest : public testing::Test {
 protected:
  const SemanticMap map_ = sampleMap();
};

TEST_F(VoxelSelectionTest, TakesOccupiedVoxelsAndOnRequestFreeOnes) {
  const auto occupied = [](const Eigen::Vector3d&, const DirichletVoxel& v) {
    return v.state() == VoxelState::Occupied;
  };
  EXPECT_EQ(selected(VoxelSelection(map_)), voxelsThat(map_, occupied));
  EXPECT_EQ(selected(VoxelSelection(map_).withFreeVoxels(true)).size(), map_.knownVoxelCount());
}

TEST_F(VoxelSelectionTest, FiltersByClassBoxProbabilityAndEvidence) {
  const auto expect = [&](const VoxelFilter& filter, auto&& holds) {
    const Voxels expected = voxelsThat(map_, [&](const Eigen::Vector3d& c, const auto& v) {
      return v.state() == VoxelState::Occupied && holds(c, v);
    });
    EXPECT_FALSE(expected.empty());
    EXPECT_LT(expected.size(), selected(VoxelSelection(map_)).size());
    EXPECT_EQ(selected(VoxelSelection(map_, filter)), expected);
  };
  VoxelFilter filter;
  filter.classes = {2};
  expect(filter, [](const auto&, const auto& v) { return v.mostLikelyClass() == 2; });
  filter = {};
  filter.box = Eigen::AlignedBox3d(Eigen::Vector3d(0, -1, -1), Eigen::Vector3d(4, 2.125, 3));
  expect(filter, [&](const Eigen::Vector3d& c, const auto&) { return filter.box->contains(c); });
  filter = {};
  filter.min_probability = 0.7;
  expect(filter,
         [](const auto&, const auto& v) { return v.probability(v.mostLikelyClass()) >= 0.7; });
  filter = {};
  filter.min_evidence = 1;
  expect(filter, [](const auto&, const auto& v) { return v.evidence() >= 1; });
}

TEST_F(VoxelSelectionTest, SaysThatNothingPasses) {
  VoxelFilter filter;
  filter.min_evidence = 1e9;
  EXPECT_THROW(VoxelSelection(map_, filter).requireVoxels(), ConfigError);
  filter = {};
  // Narrower than a voxel, between two centres.
  filter.box = Eigen::AlignedBox3d(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.1, 1, 1));
  EXPECT_THROW(VoxelSelection(map_, filter).requireVoxels(), ConfigError);
  EXPECT_EQ(VoxelSelection(map_, filter).resampledBounds(), std::nullopt);
  EXPECT_NO_THROW(VoxelSelection(map_).requireVoxels());
}

TEST_F(VoxelSelectionTest, ResamplingWithoutAPoseChangesNothing) {
  const VoxelSelection all = VoxelSelection(map_).withFreeVoxels(true);
  EXPECT_EQ(resampled(all), selected(all));
}

TEST_F(VoxelSelectionTest, PosesOfWholeVoxelsAndRightAnglesMoveVoxelsExactly) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(0.25 * 7, -0.25 * 3, 0.25));
  pose.rotate(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  const VoxelSelection moved = VoxelSelection(map_, {}, pose).withFreeVoxels(true);
  Voxels expected;
  for (const auto& [i, k] : selected(moved))
    expected[std::array{-i[1] - 1 + 7, i[0] - 3, i[2] + 1}] = k;
  EXPECT_EQ(resampled(moved), expected);
}

TEST_F(VoxelSelectionTest, AnyPoseGivesEachVoxelWhatTheMapHasThere) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> offset(-1, 1);
  for (int trial = 0; trial < 5; ++trial) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translate(Eigen::Vector3d(offset(random), offset(random), offset(random)));
    pose.rotate(Eigen::Quaterniond(offset(random), offset(random), offset(random), offset(random))
                    .normalized());
    const VoxelSelection moved(map_, {}, pose);
    const Voxels voxels = resampled(moved);
    const auto bounds = moved.resampledBounds();
    ASSERT_TRUE(bounds);
    std::size_t occupied = 0;
    for (int z = bounds->min.z - 1; z <= bounds->max.z + 1; ++z)
      for (int y = bounds->min.y - 1; y <= bounds->max.y + 1; ++y)
        for (int x = bounds->min.x - 1; x <= bounds->max.x + 1; ++x) {
          const Eigen::Vector3d point = pose.inverse() * map_.grid().center({x, y, z});
          const DirichletVoxel v = map_.at(point);
          if (v.state() != VoxelState::Occupied) continue;
          ++occupied;
          const auto found = voxels.find({x, y, z});
          ASSERT_NE(found, voxels.end());
          EXPECT_EQ(found->second, v.mostLikelyClass());
        }
    EXPECT_EQ(occupied, voxels.size());
  }
}

TEST_F(VoxelSelectionTest, RefusesPosesBeyondTheGrid) {
  const Eigen::Isometry3d far(Eigen::Translation3d(1e9, 0, 0));
  EXPECT_THROW(resampled(VoxelSelection(map_, {}, far)), ConfigError);
}

TEST(VoxelsWithCenterIn, B4_ACentreLiesInABoxMadeOfIt) {
  for (const double resolution : {0.05, 0.1, 0.15, 0.2, 0.3, 0.7, 1.0 / 3}) {
    const Grid grid(resolution);
    for (std::int32_t i = -5000; i <= 5000; ++i) {
      const VoxelIndex index{i, 3 * i, -7 * i};
      const Eigen::Vector3d center = grid.center(index);
      const auto box = voxelsWithCenterIn(grid, Eigen::AlignedBox3d(center, center));
      ASSERT_TRUE(box) << resolution << ", " << i;
      ASSERT_EQ(box->min, index) << resolution;
      ASSERT_EQ(box->max, index) << resolution;
    }
  }
}

TEST(VoxelsWithCenterIn, B4_TheLastLayersAndWhatLiesBeyond) {
  const Grid grid(0.1);
  const VoxelIndex last{kLastVoxelIndex, kFirstVoxelIndex, 0};
  const Eigen::Vector3d center = grid.center(last);
  const auto box = voxelsWithCenterIn(grid, Eigen::AlignedBox3d(center, center));
  ASSERT_TRUE(box);
  EXPECT_EQ(box->min, last);
  const Eigen::Vector3d far(1e300, 1e300, 1e300);
  const auto all = voxelsWithCenterIn(grid, Eigen::AlignedBox3d(-far, far));
  ASSERT_TRUE(all);
  EXPECT_EQ(all->min.x, kFirstVoxelIndex);
  EXPECT_EQ(all->max.x, kLastVoxelIndex);
  EXPECT_FALSE(voxelsWithCenterIn(grid, Eigen::AlignedBox3d(0.5 * far, far)));
  EXPECT_FALSE(voxelsWithCenterIn(
      grid, Eigen::AlignedBox3d(Eigen::Vector3d(0.06, 0, 0), Eigen::Vector3d(0.14, 1, 1))));
}

}  // namespace
}  // namespace csom::test
