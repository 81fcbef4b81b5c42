// SPDX-License-Identifier: BSD-3-Clause
// Octrees, read back by liboctomap.
#include <csom/exports/OctomapFile.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <memory>

#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::HasSubstr;

class OctomapFileTest : public testing::Test {
 protected:
  std::unique_ptr<octomap::ColorOcTree> readColorTree(const std::string& file) {
    std::unique_ptr<octomap::AbstractOcTree> tree(octomap::AbstractOcTree::read(file));
    auto* colored = dynamic_cast<octomap::ColorOcTree*>(tree.get());
    if (colored != nullptr) (void)tree.release();
    return std::unique_ptr<octomap::ColorOcTree>(colored);
  }

  std::unique_ptr<octomap::OcTree> readBinaryTree(const std::string& file) {
    constexpr double kReplacedByTheFile = 1;
    auto tree = std::make_unique<octomap::OcTree>(kReplacedByTheFile);
    return tree->readBinary(file) ? std::move(tree) : nullptr;
  }

  /// Volume of the leaves, in voxels.
  template <class Tree>
  static std::size_t leafVoxels(const Tree& tree) {
    std::size_t voxels = 0;
    for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf)
      voxels += std::size_t{1} << (3 * (tree.getTreeDepth() - leaf.getDepth()));
    return voxels;
  }

  /// Requires every voxel of the map to be in the tree, in the same state, and no other.
  template <class Tree, class Check>
  void expectSameVoxels(const Tree& tree, Check&& check) {
    map_.forEachVoxel([&](const VoxelIndex& index, const DirichletVoxel& voxel) {
      const Eigen::Vector3d c = map_.grid().center(index);
      const auto* leaf = tree.search(c.x(), c.y(), c.z());
      ASSERT_NE(leaf, nullptr);
      EXPECT_EQ(tree.isNodeOccupied(leaf), voxel.state() == VoxelState::Occupied);
      check(*leaf, voxel);
    });
    EXPECT_EQ(leafVoxels(tree), map_.knownVoxelCount());
  }

  const SemanticMap map_ = sampleMap();
  const LabelSet labels_ = sampleLabels();
  TempFolder folder_;
};

TEST_F(OctomapFileTest, ColorTreeHasStatesClassesAndOccupancies) {
  const std::string file = folder_ / "map.ot";
  EXPECT_EQ(writeOctomap(VoxelSelection(map_), labels_, file), VoxelSelection(map_).count());
  const auto tree = readColorTree(file);
  ASSERT_TRUE(tree);
  EXPECT_EQ(tree->getResolution(), 0.25);
  expectSameVoxels(*tree, [&](const octomap::ColorOcTreeNode& leaf, const DirichletVoxel& v) {
    const Color& color = labels_.at(v.mostLikelyClass()).color;
    EXPECT_TRUE(leaf.getColor() == octomap::ColorOcTreeNode::Color(color[0], color[1], color[2]));
    if (v.occupancy() > 0.6 && v.occupancy() < 0.9 && v.state() == VoxelState::Occupied) {
      EXPECT_NEAR(leaf.getOccupancy(), v.occupancy(), 1e-6);
    }
  });
}

TEST_F(OctomapFileTest, BinaryTreeHasStates) {
  const std::string file = folder_ / "map.bt";
  writeOctomap(VoxelSelection(map_), labels_, file);
  const auto tree = readBinaryTree(file);
  ASSERT_TRUE(tree);
  expectSameVoxels(*tree, [](const auto&, const auto&) {});
}

/// A solid cube whose halves differ in class: equal leaves become one, but never across classes.
TEST_F(OctomapFileTest, PrunesWithinAClass) {
  Options options;
  options.number_of_classes = 3;
  options.resolution = 1;
  options.method = Method::SCsm;
  SemanticMap map(options);
  Scan scan;
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x) {
        scan.points.emplace_back(Eigen::Array3f(0.5F) + Eigen::Array3i(x, y, z).cast<float>());
        scan.labels.push_back(x < 3 ? 1 : 2);
      }
  scan.origin = {0, 0, 0};
  map.insert(scan);
  ASSERT_EQ(map.knownVoxelCount(), 64U);
  writeOctomap(VoxelSelection(map), labels_, folder_ / "map.ot");
  const auto tree = readColorTree(folder_ / "map.ot");
  ASSERT_TRUE(tree);
  // Of the 8 cubes of 2 voxels, the 4 at x < 2 are of one class; the others are 4 × 8 leaves.
  EXPECT_EQ(tree->getNumLeafNodes(), 4U + 32U);
  EXPECT_EQ(leafVoxels(*tree), 64U);
  EXPECT_EQ(tree->search(3.5, 0.5, 0.5)->getColor().r, labels_.at(2).color[0]);
  EXPECT_EQ(tree->search(2.5, 0.5, 0.5)->getColor().r, labels_.at(1).color[0]);
}

TEST_F(OctomapFileTest, FilteredVoxelsAreUnknown) {
  VoxelFilter filter;
  filter.classes = {2};
  writeOctomap(VoxelSelection(map_, filter), labels_, folder_ / "map.bt");
  const auto tree = readBinaryTree(folder_ / "map.bt");
  ASSERT_TRUE(tree);
  map_.forEachVoxel([&](const VoxelIndex& index, const DirichletVoxel& voxel) {
    const Eigen::Vector3d c = map_.grid().center(index);
    const auto* leaf = tree->search(c.x(), c.y(), c.z());
    EXPECT_EQ(leaf == nullptr, voxel.mostLikelyClass() == 1);
  });
}

TEST_F(OctomapFileTest, RefusesWhatAnOctreeCannotHold) {
  const Eigen::Isometry3d far(Eigen::Translation3d(32768 * 0.25, 0, 0));
  try {
    writeOctomap(VoxelSelection(map_, {}, far), labels_, folder_ / "map.bt");
    ADD_FAILURE();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.options(), testing::ElementsAre("box", "frame"));
  }
  EXPECT_THROW(writeOctomap(VoxelSelection(map_), labels_, folder_ / "map.octomap"), ConfigError);
  EXPECT_THAT(folder_.fileNames(), testing::IsEmpty());
  EXPECT_THAT(fileErrorOf([&] { writeOctomap(VoxelSelection(map_), labels_, "/nowhere/map.bt"); }),
              HasSubstr("/nowhere/map.bt: cannot be written"));
}

}  // namespace
}  // namespace csom::test
