// SPDX-License-Identifier: BSD-3-Clause
// The figures of small maps, against counts by hand.
#include <csom/report/MapFigures.h>
#include <gtest/gtest.h>

#include "SampleMaps.h"

namespace csom {
namespace {

TEST(MapFiguresTest, AnEmptyMapHasNothing) {
  const MapFigures figures = computeFigures(test::mapOf({}));
  EXPECT_EQ(figures.known_voxels, 0u);
  EXPECT_EQ(figures.chunks, 0u);
  EXPECT_TRUE(figures.bounds.isEmpty());
  ASSERT_EQ(figures.classes.size(), 5u);
  for (const ClassFigures& c : figures.classes) {
    EXPECT_EQ(c.voxels, 0u);
    EXPECT_EQ(c.share, 0);
    EXPECT_EQ(c.mean_probability, 0);
  }
}

TEST(MapFiguresTest, CountsVoxelsByStateAndClass) {
  const MapDocument document =
      test::mapOf({{{0, 0, 0}, 1}, {{1, 0, 0}, 1}, {{2, 0, 0}, 1}, {{0, 0, 1}, 2}, {{5, 5, 5}, 0}});
  const MapFigures figures = computeFigures(document);
  EXPECT_EQ(figures.known_voxels, 5u);
  EXPECT_EQ(figures.occupied_voxels, 4u);
  EXPECT_EQ(figures.free_voxels, 1u);
  EXPECT_EQ(figures.chunks, 1u);
  EXPECT_EQ(figures.memory_bytes, document.map.memoryBytes());
  EXPECT_EQ(figures.digest, mapDigest(document.map));

  EXPECT_EQ(figures.classes[1].name, "ground");
  EXPECT_EQ(figures.classes[1].color, (Color{200, 0, 0}));
  EXPECT_EQ(figures.classes[1].voxels, 3u);
  EXPECT_DOUBLE_EQ(figures.classes[1].share, 0.75);
  EXPECT_DOUBLE_EQ(figures.classes[2].share, 0.25);
  EXPECT_EQ(figures.classes[0].voxels, 1u);
  EXPECT_EQ(figures.classes[0].share, 0) << "free voxels have no share in the occupied ones";
}

TEST(MapFiguresTest, VolumeAndBoundsAreMetric) {
  const MapFigures figures = computeFigures(test::mapOf({{{-2, 0, 0}, 3}, {{3, 1, 0}, 3}}, 0.5));
  EXPECT_DOUBLE_EQ(figures.resolution, 0.5);
  EXPECT_DOUBLE_EQ(figures.classes[3].volume, 2 * 0.125);
  EXPECT_TRUE(figures.bounds.min().isApprox(Eigen::Vector3d(-1, 0, 0)));
  EXPECT_TRUE(figures.bounds.max().isApprox(Eigen::Vector3d(2, 1, 0.5)));
}

TEST(MapFiguresTest, MeanProbabilityAveragesOverTheVoxelsOfAClass) {
  // Voxel a: ground twice, tree once; voxel b: ground once.
  const MapDocument document =
      test::mapOf({{{0, 0, 0}, 1}, {{0, 0, 0}, 1}, {{0, 0, 0}, 2}, {{1, 0, 0}, 1}});
  const double in_a = document.map.voxel({0, 0, 0}).probability(1);
  const double in_b = document.map.voxel({1, 0, 0}).probability(1);
  ASSERT_LT(in_a, in_b);
  EXPECT_DOUBLE_EQ(computeFigures(document).classes[1].mean_probability, (in_a + in_b) / 2);
}

TEST(MapFiguresTest, NamesClassesThatTheLabelSetDoesNotKnow) {
  MapDocument document = test::mapOf({{{0, 0, 0}, 4}});
  document.labels = LabelSet::occupancy();
  const MapFigures figures = computeFigures(document);
  ASSERT_EQ(figures.classes.size(), 5u);
  EXPECT_EQ(figures.classes[4].name, "class 4");
  EXPECT_EQ(figures.classes[4].voxels, 1u);
}

}  // namespace
}  // namespace csom
