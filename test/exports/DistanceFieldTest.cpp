// SPDX-License-Identifier: BSD-3-Clause
// Distances, held against a search through all voxels, and read back by NumPy.
#include <csom/core/Error.h>
#include <csom/exports/DistanceField.h>

#include <random>

#include "apps/RunCsom.h"
#include "eval/LabelledVoxels.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::HasSubstr;

/// `stretch`: of the place along x.
SemanticMap scatteredMap(int stretch = 1) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> place(-15, 15);
  std::vector<LabelledVoxel> voxels;
  for (int i = 0; i < 120; ++i)
    voxels.push_back(
        {{stretch * place(random), place(random), place(random)}, static_cast<ClassId>(i % 4)});
  return mapOf(voxels);
}

/// By definition.
double nearestOf(const SemanticMap& map, ClassId k, const Eigen::Vector3d& center, double max) {
  double nearest = max;
  map.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
    if (voxel.mostLikelyClass() == k)
      nearest = std::min(nearest, (map.grid().center(v) - center).norm());
  });
  return nearest;
}

template <class Visitor>
void forEachIn(const VoxelBox& box, Visitor&& visit) {
  VoxelIndex v;
  for (v.z = box.min.z; v.z <= box.max.z; ++v.z)
    for (v.y = box.min.y; v.y <= box.max.y; ++v.y)
      for (v.x = box.min.x; v.x <= box.max.x; ++v.x) visit(v);
}

TEST(DistanceField, IsTheDistanceToTheNearestObstacle) {
  const SemanticMap map = scatteredMap();
  VoxelFilter filter;
  filter.classes = {2};
  const double max_distance = 4.2;
  const DistanceField field(VoxelSelection(map, filter), max_distance);
  EXPECT_EQ(field.box().min, map.boundingBox()->min);
  EXPECT_EQ(field.box().max, map.boundingBox()->max);
  std::size_t cut_off = 0;
  forEachIn(field.box(), [&](const VoxelIndex& v) {
    const double truth = nearestOf(map, 2, map.grid().center(v), max_distance);
    EXPECT_NEAR(field.distance(v), truth, 1e-6);
    EXPECT_EQ(field.state(v), map.voxel(v).state());
    cut_off += truth == max_distance ? 1 : 0;
  });
  EXPECT_GT(cut_off, 100U);
}

// With a margin of 30 voxels it is computed in several pieces; across their borders, too, it is the
// distance.
TEST(DistanceField, OfALargeBoxIsTheSame) {
  const SemanticMap map = scatteredMap(20);
  const double max_distance = 15;
  VoxelFilter filter;
  filter.classes = {2};
  const DistanceField field(VoxelSelection(map, filter), max_distance);
  ASSERT_GT(field.size()[0], 500);
  std::size_t checked = 0;
  std::size_t cut_off = 0;
  forEachIn(field.box(), [&](const VoxelIndex& v) {
    if ((v.x + 3 * v.y + 7 * v.z) % 50 != 0) return;
    const double truth = nearestOf(map, 2, map.grid().center(v), max_distance);
    ASSERT_NEAR(field.distance(v), truth, 1e-5);
    ++checked;
    cut_off += truth == max_distance ? 1 : 0;
  });
  EXPECT_GT(checked, 10000U);
  EXPECT_LT(cut_off, checked / 2);
}

TEST(DistanceField, CountsObstaclesBeyondTheBox) {
  const SemanticMap map = scatteredMap();
  VoxelFilter filter;
  filter.box = Eigen::AlignedBox3d(Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 2, 1.5));
  const DistanceField field(VoxelSelection(map, filter), 10);
  EXPECT_EQ(field.size(), (std::array{4, 6, 5}));
  forEachIn(field.box(), [&](const VoxelIndex& v) {
    const auto nearest = map.nearestOccupied(map.grid().center(v), 10);
    ASSERT_TRUE(nearest);
    EXPECT_NEAR(field.distance(v), nearest->distance, 1e-6);
  });
}

TEST(DistanceField, FollowsTheFrame) {
  const SemanticMap map = scatteredMap();
  VoxelFilter filter;
  filter.box = Eigen::AlignedBox3d(Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 2, 1.5));
  const VoxelIndex shift{7, -3, 2};
  const Eigen::Isometry3d frame(Eigen::Translation3d(3.5, -1.5, 1));
  const DistanceField here(VoxelSelection(map, filter), 5);
  const DistanceField there(VoxelSelection(map, filter, frame), 5);
  ASSERT_EQ(here.size(), there.size());
  forEachIn(here.box(), [&](const VoxelIndex& v) {
    const VoxelIndex moved{v.x + shift.x, v.y + shift.y, v.z + shift.z};
    EXPECT_EQ(here.distance(v), there.distance(moved));
    EXPECT_EQ(here.state(v), there.state(moved));
  });
}

constexpr char kPrintField[] = R"(
import sys, numpy
with numpy.load(sys.argv[1]) as field:
    assert field['distance'].dtype == numpy.float32 and field['state'].dtype == numpy.uint8
    print(*field['distance'].shape, *field['origin'], field['resolution'], field['max_distance'])
    for z, y, x in numpy.ndindex(field['distance'].shape):
        print(float(field['distance'][z, y, x]).hex(), field['state'][z, y, x])
)";

TEST(DistanceField, NumPyReadsIt) {
  const TempFolder folder;
  const SemanticMap map = scatteredMap();
  VoxelFilter filter;
  filter.box = Eigen::AlignedBox3d(Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 2, 1.5));
  const DistanceField field(VoxelSelection(map, filter), 3);
  writeDistanceField(field, folder / "map.npz");
  const ProgramResult python =
      runProgram(folder.path(), "/usr/bin/python3", {"-c", kPrintField, folder / "map.npz"});
  ASSERT_EQ(python.exit_code, 0) << python.errors;
  std::istringstream lines(python.output);
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_EQ(line, "5 6 4 -0.75 -0.75 -0.75 0.5 3.0");
  forEachIn(field.box(), [&](const VoxelIndex& v) {
    ASSERT_TRUE(std::getline(lines, line));
    float distance = -1;
    int state = -1;
    ASSERT_EQ(std::sscanf(line.c_str(), "%a %d", &distance, &state), 2);
    EXPECT_EQ(distance, field.distance(v));
    EXPECT_EQ(state, static_cast<int>(field.state(v)));
  });
  EXPECT_FALSE(std::getline(lines, line));
}

TEST(DistanceField, SaysWhyThereIsNone) {
  const SemanticMap map = scatteredMap();
  const auto errorOf = [&](const SemanticMap& of, const VoxelFilter& filter,
                           double max_distance) -> std::string {
    try {
      DistanceField(VoxelSelection(of, filter), max_distance);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(errorOf(map, {}, 0), HasSubstr("the maximum distance"));
  EXPECT_THAT(errorOf(map, {}, NAN), HasSubstr("the maximum distance"));
  EXPECT_THAT(errorOf(map, {}, 1e9), HasSubstr("the maximum distance"));
  EXPECT_THAT(errorOf(map, {}, 1000), HasSubstr("does not fit into memory"));
  EXPECT_THAT(errorOf(SemanticMap(), {}, 1), HasSubstr("the map is empty"));
  VoxelFilter filter;
  filter.min_evidence = 1e9;
  EXPECT_THAT(errorOf(map, filter, 1), HasSubstr("no voxel of the map passes"));
  filter = {};
  filter.box = Eigen::AlignedBox3d(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.1, 1, 1));
  EXPECT_THAT(errorOf(map, filter, 1), HasSubstr("no voxel's centre lies in the box"));
}

}  // namespace
}  // namespace csom::test
