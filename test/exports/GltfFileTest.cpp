// SPDX-License-Identifier: BSD-3-Clause
// Meshes, read back by tinygltf.
#include <csom/exports/GltfFile.h>

#include <random>

#include "eval/LabelledVoxels.h"
#include "exports/GlbReader.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::HasSubstr;

LabelSet fourClasses() {
  return LabelSet::fromYaml(
      "name: four\nclasses:\n  - {id: 0, name: free, color: [255, 255, 255]}\n"
      "  - {id: 1, name: a, color: [10, 20, 30]}\n  - {id: 2, name: b, color: [200, 0, 7]}\n"
      "  - {id: 3, name: c, color: [0, 255, 100]}\n",
      "four");
}

TEST(GltfFile, HasExactlyTheFacesOfTheSurface) {
  const TempFolder folder;
  const SemanticMap map = sampleMap();
  const std::size_t triangles = writeGlb(VoxelSelection(map), sampleLabels(), folder / "map.glb");
  const MeshFaces read = readGlb(folder / "map.glb", 0.25, sampleLabels());
  EXPECT_EQ(read.faces, makeFaces(map, sampleLabels()));
  EXPECT_EQ(read.triangles, triangles);
  EXPECT_LT(triangles, read.faces.size()) << "merged";
}

TEST(GltfFile, ScatteredVoxelsOfManyClasses) {
  const TempFolder folder;
  std::vector<LabelledVoxel> voxels;
  std::mt19937 random(1);
  std::uniform_int_distribution<int> place(-9, 11), class_id(0, 3);
  for (int i = 0; i < 3000; ++i)
    voxels.push_back(
        {{place(random), place(random), place(random)}, static_cast<ClassId>(class_id(random))});
  const SemanticMap map = mapOf(voxels);
  writeGlb(VoxelSelection(map), fourClasses(), folder / "map.glb");
  EXPECT_EQ(readGlb(folder / "map.glb", 0.5, fourClasses()).faces, makeFaces(map, fourClasses()));
}

TEST(GltfFile, MergesAWallAcrossChunks) {
  const TempFolder folder;
  std::vector<LabelledVoxel> wall;
  for (int y = -10; y < 30; ++y)
    for (int z = -3; z < 21; ++z) wall.push_back({{5, y, z}, static_cast<ClassId>(z < 4 ? 1 : 2)});
  // Two classes: 4 outer sides and 2 x 2 large faces of each, without any between them.
  EXPECT_EQ(writeGlb(VoxelSelection(mapOf(wall)), fourClasses(), folder / "wall.glb"), 2U * 2 * 5);
}

TEST(GltfFile, FailuresLeaveNothing) {
  const TempFolder folder;
  const SemanticMap map = sampleMap();
  const Eigen::Isometry3d far(Eigen::Translation3d(4e6, 0, 0));
  EXPECT_THROW(writeGlb(VoxelSelection(map, {}, far), sampleLabels(), folder / "a"), ConfigError);
  VoxelFilter filter;
  filter.min_evidence = 1e9;
  EXPECT_THROW(writeGlb(VoxelSelection(map, filter), sampleLabels(), folder / "a"), ConfigError);
  EXPECT_THAT(fileErrorOf([&] { writeGlb(VoxelSelection(map), sampleLabels(), "/dev/full"); }),
              HasSubstr("No space left on device"));
  EXPECT_THAT(folder.fileNames(), testing::IsEmpty());
}

}  // namespace
}  // namespace csom::test
