// SPDX-License-Identifier: BSD-3-Clause
// PLY and PCD files, read back by the Point Cloud Library.
#include <csom/exports/PointFiles.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <algorithm>

#include "io/IoFixtures.h"

namespace csom::test {
namespace {

/// Reads one field of one point, whatever its type is.
double valueOf(const pcl::PCLPointCloud2& cloud, std::size_t point, const std::string& name) {
  const auto field = std::find_if(cloud.fields.begin(), cloud.fields.end(),
                                  [&](const auto& f) { return f.name == name; });
  if (field == cloud.fields.end()) throw std::runtime_error("no field " + name);
  const std::uint8_t* at = cloud.data.data() + point * cloud.point_step + field->offset;
  const auto read = [at](auto number) {
    std::memcpy(&number, at, sizeof number);
    return static_cast<double>(number);
  };
  switch (field->datatype) {
    case pcl::PCLPointField::UINT8:
      return read(std::uint8_t{});
    case pcl::PCLPointField::UINT32:
      return read(std::uint32_t{});
    case pcl::PCLPointField::FLOAT32:
      return name == "rgb" ? read(std::uint32_t{}) : read(float{});
    case pcl::PCLPointField::FLOAT64:
      return read(double{});
    default:
      throw std::runtime_error("unexpected type of " + name);
  }
}

double packed(const Color& c) {
  return (c[0] * 256.0 + c[1]) * 256.0 + c[2];
}

class PclTest : public testing::Test {
 protected:
  template <class Check>
  void expectVoxels(const pcl::PCLPointCloud2& cloud, Check&& check) {
    std::size_t i = 0;
    voxels_.forEach([&](const VoxelIndex&, const ExportedVoxel& v) {
      ASSERT_LT(i, cloud.width * cloud.height);
      EXPECT_NEAR(valueOf(cloud, i, "x"), v.center.x(), 1e-6);
      EXPECT_NEAR(valueOf(cloud, i, "y"), v.center.y(), 1e-6);
      EXPECT_NEAR(valueOf(cloud, i, "z"), v.center.z(), 1e-6);
      EXPECT_EQ(std::fmod(valueOf(cloud, i, "rgb"), 1 << 24), packed(labels_.at(v.class_id).color));
      check(i++, v);
    });
    EXPECT_EQ(i, cloud.width * cloud.height);
  }

  const SemanticMap map_ = sampleMap();
  const LabelSet labels_ = sampleLabels();
  const VoxelSelection voxels_{map_};
  TempFolder folder_;
};

TEST_F(PclTest, ReadsPly) {
  writePly(voxels_, labels_, folder_ / "map.ply");
  pcl::PCLPointCloud2 cloud;
  ASSERT_GE(pcl::PLYReader().read(folder_ / "map.ply", cloud), 0);
  expectVoxels(cloud, [&](std::size_t i, const ExportedVoxel& v) {
    EXPECT_EQ(valueOf(cloud, i, "class"), v.class_id);
    EXPECT_EQ(valueOf(cloud, i, "probability"), static_cast<float>(v.probability));
    EXPECT_EQ(valueOf(cloud, i, "variance"), static_cast<float>(v.variance));
  });
}

TEST_F(PclTest, ReadsPcd) {
  writePcd(voxels_, labels_, folder_ / "map.pcd");
  pcl::PCLPointCloud2 cloud;
  ASSERT_EQ(pcl::PCDReader().read(folder_ / "map.pcd", cloud), 0);
  expectVoxels(cloud, [&](std::size_t i, const ExportedVoxel& v) {
    EXPECT_EQ(valueOf(cloud, i, "label"), v.class_id);
  });
}

}  // namespace
}  // namespace csom::test
