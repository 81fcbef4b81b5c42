// SPDX-License-Identifier: BSD-3-Clause
#include "exports/ReadBack.h"

#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/serialization/CArchive.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#ifdef CSOM_WITH_OPENVDB
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#endif

#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "apps/RunCsom.h"

namespace csom::test {
namespace {

void add(VoxelClasses& voxels, const std::array<double, 3>& center, double resolution, int k) {
  std::array<int, 3> index{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    index[axis] = static_cast<int>(std::floor(center[axis] / resolution));
  if (!voxels.emplace(index, static_cast<ClassId>(k)).second)
    throw std::runtime_error("a voxel twice");
}

/// One field of one point as T.
template <class T>
T fieldOf(const pcl::PCLPointCloud2& cloud, std::size_t point, const std::string& name) {
  for (const auto& field : cloud.fields) {
    if (field.name != name) continue;
    T value{};
    std::memcpy(&value, cloud.data.data() + point * cloud.point_step + field.offset, sizeof value);
    return value;
  }
  throw std::runtime_error("no field " + name);
}

template <class Coordinate, class Class>
VoxelClasses voxelsOfCloud(const pcl::PCLPointCloud2& cloud, const std::string& class_field,
                           double resolution) {
  VoxelClasses voxels;
  for (std::size_t i = 0; i < std::size_t{cloud.width} * cloud.height; ++i)
    add(voxels,
        {fieldOf<Coordinate>(cloud, i, "x"), fieldOf<Coordinate>(cloud, i, "y"),
         fieldOf<Coordinate>(cloud, i, "z")},
        resolution, static_cast<int>(fieldOf<Class>(cloud, i, class_field)));
  return voxels;
}

VoxelClasses readPly(const std::string& file, double resolution, const LabelSet&) {
  pcl::PCLPointCloud2 cloud;
  if (pcl::PLYReader().read(file, cloud) < 0) throw std::runtime_error("PCL cannot read " + file);
  for (const auto& field : cloud.fields)
    if (field.name == "x" && field.datatype == pcl::PCLPointField::FLOAT32)
      return voxelsOfCloud<float, std::uint8_t>(cloud, "class", resolution);
  return voxelsOfCloud<double, std::uint8_t>(cloud, "class", resolution);
}

VoxelClasses readPcd(const std::string& file, double resolution, const LabelSet&) {
  pcl::PCLPointCloud2 cloud;
  if (pcl::PCDReader().read(file, cloud) < 0) throw std::runtime_error("PCL cannot read " + file);
  return voxelsOfCloud<float, std::uint32_t>(cloud, "label", resolution);
}

/// Lines "x<separator>y<separator>z<separator>class".
VoxelClasses readLines(std::istream& lines, const char* format, double resolution) {
  VoxelClasses voxels;
  for (std::string line; std::getline(lines, line);) {
    std::array<double, 3> center{};
    int k = -1;
    if (std::sscanf(line.c_str(), format, &center[0], &center[1], &center[2], &k) != 4)
      throw std::runtime_error("not four numbers: " + line);
    add(voxels, center, resolution, k);
  }
  return voxels;
}

VoxelClasses readCsv(const std::string& file, double resolution, const LabelSet&) {
  std::ifstream lines(file);
  std::string header;
  std::getline(lines, header);
  return readLines(lines, "%lf,%lf,%lf,%d", resolution);
}

VoxelClasses readNpz(const std::string& file, double resolution, const LabelSet&) {
  const ProgramResult python =
      runProgram(std::filesystem::path(file).parent_path().string(), "/usr/bin/python3",
                 {"-c",
                  "import sys, numpy\n"
                  "with numpy.load(sys.argv[1]) as a:\n"
                  "    for c, k in zip(a['center'].tolist(), a['class_id'].tolist()):\n"
                  "        print(*c, k)\n",
                  file});
  if (python.exit_code != 0) throw std::runtime_error(python.errors);
  std::istringstream lines(python.output);
  return readLines(lines, "%lf %lf %lf %d", resolution);
}

/// Leaves of upper levels stand for all voxels in them.
template <class Tree, class ClassOf>
VoxelClasses voxelsOfTree(const Tree& tree, ClassOf&& class_of) {
  EXPECT_GT(tree.getNumLeafNodes(), 0U);
  VoxelClasses voxels;
  const double r = tree.getResolution();
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const int side = 1 << (tree.getTreeDepth() - leaf.getDepth());
    const double first = 0.5 - side / 2.0;
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
          add(voxels,
              {leaf.getX() + (first + x) * r, leaf.getY() + (first + y) * r,
               leaf.getZ() + (first + z) * r},
              r, tree.isNodeOccupied(*leaf) ? class_of(*leaf) : kFreeClass);
  }
  return voxels;
}

VoxelClasses readColorTree(const std::string& file, double resolution, const LabelSet& labels) {
  const std::unique_ptr<octomap::AbstractOcTree> read(octomap::AbstractOcTree::read(file));
  const auto& tree = dynamic_cast<const octomap::ColorOcTree&>(*read);
  EXPECT_EQ(tree.getResolution(), resolution);
  return voxelsOfTree(tree, [&](const octomap::ColorOcTreeNode& leaf) {
    const auto color = leaf.getColor();
    return labels.classByColor({color.r, color.g, color.b}).value();
  });
}

VoxelClasses readBinaryTree(const std::string& file, double resolution, const LabelSet&) {
  octomap::OcTree tree(1);
  if (!tree.readBinary(file)) throw std::runtime_error("OctoMap cannot read " + file);
  EXPECT_EQ(tree.getResolution(), resolution);
  return voxelsOfTree(tree, [](const octomap::OcTreeNode&) { return ClassId{1}; });
}

VoxelClasses readPointMap(const std::string& file, double resolution, const LabelSet&) {
  mrpt::io::CFileGZInputStream stream(file);
  const auto points = std::dynamic_pointer_cast<mrpt::maps::CPointsMapXYZI>(
      mrpt::serialization::archiveFrom(stream).ReadObject());
  if (!points) throw std::runtime_error("no CPointsMapXYZI in " + file);
  VoxelClasses voxels;
  for (std::size_t i = 0; i < points->size(); ++i) {
    float x = 0, y = 0, z = 0;
    points->getPoint(i, x, y, z);
    add(voxels, {x, y, z}, resolution, static_cast<int>(points->getPointIntensity(i)));
  }
  return voxels;
}

#ifdef CSOM_WITH_OPENVDB
VoxelClasses readVdb(const std::string& name, double resolution, const LabelSet&) {
  openvdb::initialize();
  openvdb::io::File file(name);
  file.open();
  const auto grid = openvdb::gridPtrCast<openvdb::Int32Grid>(file.readGrid("class"));
  file.close();
  VoxelClasses voxels;
  for (auto value = grid->cbeginValueOn(); value; ++value) {
    if (!value.isVoxelValue()) throw std::runtime_error("a tile");
    const openvdb::Vec3d c = grid->indexToWorld(value.getCoord());
    add(voxels, {c.x(), c.y(), c.z()}, resolution, *value);
  }
  return voxels;
}
#endif

}  // namespace

std::vector<VoxelFormat> voxelFormats() {
  std::vector<VoxelFormat> formats{
      {"ply", "ply", false, true, readPly},
      {"pcd", "pcd", false, true, readPcd},
      {"csv", "csv", false, true, readCsv},
      {"npz", "npz", false, true, readNpz},
      {"octomap", "ot", true, true, readColorTree},
      {"octomap", "bt", true, false, readBinaryTree},
      {"points", "points", false, true, readPointMap},
  };
#ifdef CSOM_WITH_OPENVDB
  formats.push_back({"vdb", "vdb", true, true, readVdb});
#endif
  return formats;
}

VoxelClasses voxelsOf(const SemanticMap& map, const VoxelFormat& format) {
  VoxelClasses voxels;
  map.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
    const bool occupied = voxel.state() == VoxelState::Occupied;
    if (!occupied && !format.free_voxels) return;
    const ClassId k = voxel.mostLikelyClass();
    voxels[{v.x, v.y, v.z}] = occupied && !format.classes ? ClassId{1} : k;
  });
  return voxels;
}

}  // namespace csom::test
