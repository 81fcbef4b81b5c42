// SPDX-License-Identifier: BSD-3-Clause
// Grids, read back by OpenVDB.
#include <csom/exports/VdbFile.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::HasSubstr;

TEST(VdbFile, HasEveryKnownVoxel) {
  const TempFolder folder;
  const SemanticMap map = sampleMap();
  EXPECT_EQ(writeVdb(VoxelSelection(map), sampleLabels(), folder / "map.vdb"),
            map.knownVoxelCount());

  openvdb::initialize();
  openvdb::io::File file(folder / "map.vdb");
  file.open();
  const auto classes = openvdb::gridPtrCast<openvdb::Int32Grid>(file.readGrid("class"));
  const auto occupancy = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("occupancy"));
  const auto variance = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("variance"));
  file.close();
  ASSERT_TRUE(classes && occupancy && variance);
  EXPECT_EQ(classes->activeVoxelCount(), map.knownVoxelCount());
  EXPECT_EQ(occupancy->activeVoxelCount(), map.knownVoxelCount());
  EXPECT_EQ(variance->activeVoxelCount(), map.knownVoxelCount());
  map.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
    // Found by its place in the world, so that the transform is tried as well.
    const Eigen::Vector3d c = map.grid().center(v);
    const openvdb::Vec3d place = classes->transform().worldToIndex({c.x(), c.y(), c.z()});
    const openvdb::Coord at = openvdb::Coord::round(place);
    EXPECT_NEAR((place - at.asVec3d()).length(), 0, 1e-9);
    const ClassId k = voxel.mostLikelyClass();
    EXPECT_TRUE(classes->tree().isValueOn(at));
    EXPECT_EQ(classes->tree().getValue(at), k);
    EXPECT_EQ(occupancy->tree().getValue(at), static_cast<float>(voxel.occupancy()));
    EXPECT_EQ(variance->tree().getValue(at), static_cast<float>(voxel.variance(k)));
  });
}

TEST(VdbFile, FailuresLeaveNothing) {
  const TempFolder folder;
  const SemanticMap map = sampleMap();
  VoxelFilter filter;
  filter.min_evidence = 1e9;
  EXPECT_THROW(writeVdb(VoxelSelection(map, filter), sampleLabels(), folder / "a"), ConfigError);
  EXPECT_THAT(fileErrorOf([&] { writeVdb(VoxelSelection(map), sampleLabels(), "/dev/full"); }),
              HasSubstr("/dev/full: cannot be written"));
  EXPECT_THAT(folder.fileNames(), testing::IsEmpty());
}

}  // namespace
}  // namespace csom::test
