// SPDX-License-Identifier: BSD-3-Clause
// What 3-D views show of a map.
#include <csom/maps/CSemanticContinuousMap.h>
#include <gmock/gmock.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/opengl/COctoMapVoxels.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/serialization/CArchive.h>

#include "SampleObservations.h"

namespace csom {
namespace {

using mrpt::img::TColor;
using mrpt::opengl::COctoMapVoxels;
using mrpt::opengl::VOXEL_SET_FREESPACE;
using mrpt::opengl::VOXEL_SET_OCCUPIED;
using sample::pointCloud;

constexpr unsigned kUnknown = 2;

/// A block of `edge` voxels a side that all hold points.
CSemanticContinuousMap blockMap(int edge, FreeSpace free_space = FreeSpace::None) {
  Options options;
  options.method = Method::SCsm;
  options.resolution = 0.1;
  options.free_space.mode = free_space;
  options.number_of_classes = sample::sampleLabels().numberOfClasses();
  CSemanticContinuousMap map(options, sample::sampleLabels());
  map.insertionOptions.point_labels = PointLabels::ByIntensity;
  std::vector<Eigen::Vector3f> points;
  std::vector<float> labels;
  for (int x = 0; x < edge; ++x)
    for (int y = 0; y < edge; ++y)
      for (int z = 0; z < edge; ++z) {
        points.emplace_back(Eigen::Vector3f(static_cast<float>(x) + 10.5f,
                                            static_cast<float>(y) + 0.5f,
                                            static_cast<float>(z) + 0.5f) *
                            0.1f);
        labels.push_back(50);
      }
  map.insertObservation(*pointCloud(points, labels));
  return map;
}

COctoMapVoxels::Ptr voxelsOf(const CSemanticContinuousMap& map) {
  mrpt::opengl::CSetOfObjects scene;
  map.getVisualizationInto(scene);
  return scene.empty() ? nullptr : scene.getByClass<COctoMapVoxels>();
}

TEST(Rendering, VoxelsThatOthersHideAreLeftOut) {
  CSemanticContinuousMap map = blockMap(5);
  EXPECT_EQ(voxelsOf(map)->getVoxelCount(VOXEL_SET_OCCUPIED), 5u * 5 * 5 - 3 * 3 * 3);
  map.renderingOptions.visible_only = false;
  EXPECT_EQ(voxelsOf(map)->getVoxelCount(VOXEL_SET_OCCUPIED), 5u * 5 * 5);
  map.renderingOptions.occupied_voxels = false;
  EXPECT_EQ(voxelsOf(map)->getVoxelCount(VOXEL_SET_OCCUPIED), 0u);
}

TEST(Rendering, ColoursSayTheClass) {
  const auto voxels = voxelsOf(blockMap(2));
  for (std::size_t i = 0; i < voxels->getVoxelCount(VOXEL_SET_OCCUPIED); ++i)
    EXPECT_EQ(voxels->getVoxel(VOXEL_SET_OCCUPIED, i).color, TColor(0, 200, 0));
}

/// Colours go from blue to red.
TEST(Rendering, ColoursSayTheHeight) {
  CSemanticContinuousMap map = blockMap(4);
  map.renderingOptions.color_by = VoxelColor::Height;
  const auto voxels = voxelsOf(map);
  for (std::size_t i = 0; i < voxels->getVoxelCount(VOXEL_SET_OCCUPIED); ++i) {
    const auto& voxel = voxels->getVoxel(VOXEL_SET_OCCUPIED, i);
    const int redder = voxel.color.R - voxel.color.B;
    if (voxel.coords.z < 0.1f) {
      EXPECT_LT(redder, -50) << "at the bottom";
    }
    if (voxel.coords.z > 0.3f) {
      EXPECT_GT(redder, 50) << "at the top";
    }
  }
}

TEST(Rendering, ColoursSayTheProbability) {
  CSemanticContinuousMap map = blockMap(1);
  map.renderingOptions.color_by = VoxelColor::Probability;
  const TColor sure = voxelsOf(map)->getVoxel(VOXEL_SET_OCCUPIED, 0).color;
  map.insertObservation(*pointCloud({{1.05f, 0.05f, 0.05f}, {1.05f, 0.06f, 0.05f}}, {40, 50}));
  const TColor unsure = voxelsOf(map)->getVoxel(VOXEL_SET_OCCUPIED, 0).color;
  EXPECT_GT(sure.R, sure.G) << "red";
  EXPECT_GT(unsure.G, sure.G) << "two thirds: yellow";
}

TEST(Rendering, FreeAndUnknownVoxelsOnDemand) {
  CSemanticContinuousMap map = blockMap(1, FreeSpace::Raycast);
  EXPECT_EQ(voxelsOf(map)->getVoxelCount(VOXEL_SET_FREESPACE), 0u);
  EXPECT_EQ(voxelsOf(map)->getVoxelCount(kUnknown), 0u);

  map.renderingOptions.free_voxels = true;
  map.renderingOptions.unknown_voxels = true;
  const auto voxels = voxelsOf(map);
  std::size_t free_count = 0;
  map.map().forEachVoxel([&](const VoxelIndex&, const DirichletVoxel& voxel) {
    if (voxel.state() == VoxelState::Free) ++free_count;
  });
  ASSERT_GT(free_count, 8u);
  EXPECT_EQ(voxels->getVoxelCount(VOXEL_SET_FREESPACE), free_count) << "a beam hides nothing";
  EXPECT_LT(voxels->getVoxel(VOXEL_SET_FREESPACE, 0).color.A, 50);
  // Every voxel of a straight beam has four free sides, and one more at its first end.
  EXPECT_EQ(voxels->getVoxelCount(kUnknown), 4 * free_count + 1);
  for (std::size_t i = 0; i < voxels->getVoxelCount(kUnknown); ++i) {
    const auto& voxel = voxels->getVoxel(kUnknown, i);
    EXPECT_EQ(
        map.map()
            .at(Eigen::Vector3f(voxel.coords.x, voxel.coords.y, voxel.coords.z).cast<double>())
            .state(),
        VoxelState::Unknown);
    EXPECT_LT(voxel.color.A, 50);
  }
}

TEST(Rendering, TheBoxHoldsAllThatIsShown) {
  CSemanticContinuousMap map = blockMap(1, FreeSpace::Raycast);
  map.renderingOptions.unknown_voxels = true;
  const auto voxels = voxelsOf(map);
  const auto box = voxels->getBoundingBox();
  for (std::size_t i = 0; i < voxels->getVoxelCount(kUnknown); ++i) {
    const auto& at = voxels->getVoxel(kUnknown, i).coords;
    EXPECT_TRUE(box.min.x < at.x && at.x < box.max.x && box.min.y < at.y && at.y < box.max.y &&
                box.min.z < at.z && at.z < box.max.z);
  }
}

TEST(Rendering, ASavedSceneIsReadBack) {
  mrpt::opengl::COpenGLScene scene;
  auto objects = mrpt::opengl::CSetOfObjects::Create();
  blockMap(3).getVisualizationInto(*objects);
  scene.insert(objects);
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << scene;
  stream.Seek(0);
  mrpt::opengl::COpenGLScene read;
  archive >> read;
  const auto voxels = read.getByClass<COctoMapVoxels>();
  ASSERT_NE(voxels, nullptr);
  EXPECT_EQ(voxels->getVoxelCount(VOXEL_SET_OCCUPIED), 26u);
}

TEST(Rendering, WordsOfColours) {
  VoxelColor color = VoxelColor::Class;
  parse("color_by", "height", color);
  EXPECT_EQ(color, VoxelColor::Height);
  try {
    parse("color_by", "depth", color);
    FAIL();
  } catch (const OptionError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("color_by"));
    EXPECT_THAT(error.what(), testing::HasSubstr("probability"));
  }
}

}  // namespace
}  // namespace csom
