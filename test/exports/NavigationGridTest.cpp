// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/exports/NavigationGrid.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "eval/LabelledVoxels.h"

namespace csom::test {
namespace {

using testing::HasSubstr;

constexpr ClassId kFloor = 1;
constexpr ClassId kWall = 2;
constexpr ClassId kRug = 3;

/// One column of voxels of 0.5 m beside a lonely floor at (0, 0, 0), in the cell (1, 0).
struct Column {
  std::string what;
  std::vector<std::pair<int, ClassId>> voxels;  ///< height of the voxel, class
  NavigationGrid::State state;
  std::optional<ClassId> class_id;
};

NavigationGrid gridOf(const Column& column, const NavigationOptions& options) {
  std::vector<LabelledVoxel> voxels{{{0, 0, 0}, kFloor}};
  for (const auto& [z, k] : column.voxels) voxels.push_back({{1, 0, z}, k});
  // The map must live as long as the selection, the grid need not.
  const SemanticMap map = mapOf(voxels);
  return NavigationGrid(VoxelSelection(map), options);
}

void expectColumns(const std::vector<Column>& columns, const NavigationOptions& options) {
  for (const Column& column : columns) {
    const NavigationGrid grid = gridOf(column, options);
    ASSERT_EQ(grid.width(), 2) << column.what;
    ASSERT_EQ(grid.height(), 1) << column.what;
    EXPECT_EQ(grid.state(1, 0), column.state) << column.what;
    EXPECT_EQ(grid.classAt(1, 0), column.class_id) << column.what;
  }
}

TEST(NavigationGrid, TakesGroundFromTraversableClasses) {
  using State = NavigationGrid::State;
  NavigationOptions options;
  options.traversable = {kFloor, kRug};
  options.robot_height = 1;
  expectColumns(
      {
          {"floor", {{0, kFloor}}, State::Free, kFloor},
          {"rug on floor", {{0, kFloor}, {1, kRug}}, State::Free, kFloor},
          {"wall on floor", {{0, kFloor}, {1, kWall}}, State::Occupied, kWall},
          {"wall without floor", {{1, kWall}}, State::Occupied, kWall},
          {"lowest obstacle tells the class",
           {{1, kWall}, {2, kRug}, {0, kFloor}},
           State::Occupied,
           kWall},
          {"just within the robot's height", {{0, kFloor}, {2, kWall}}, State::Occupied, kWall},
          {"just above the robot's height", {{0, kFloor}, {3, kWall}}, State::Free, kFloor},
          {"above, and nothing known below", {{3, kWall}}, State::Unknown, std::nullopt},
          {"above, and free below", {{3, kWall}, {1, kFreeClass}}, State::Free, kFreeClass},
          {"free above the robot", {{3, kFreeClass}}, State::Unknown, std::nullopt},
          {"free below the ground", {{-1, kFreeClass}}, State::Unknown, std::nullopt},
          {"below the ground", {{0, kWall}}, State::Unknown, std::nullopt},
          {"floor on a wall is no ground", {{1, kWall}, {2, kFloor}}, State::Occupied, kWall},
          {"ground of its own height", {{4, kFloor}, {7, kWall}}, State::Free, kFloor},
          {"obstacle on its own height", {{4, kFloor}, {5, kWall}}, State::Occupied, kWall},
      },
      options);
}

TEST(NavigationGrid, TakesGroundFromTheBand) {
  using State = NavigationGrid::State;
  NavigationOptions options;
  options.band = {0.5, 2.5};
  options.robot_height = 1;
  // The lonely floor lies below the band, and a free voxel above it makes a free cell.
  const Column beside{"", {{1, kFreeClass}}, State::Free, kFreeClass};
  std::vector<Column> columns{
      {"at the lower end", {{1, kWall}}, State::Occupied, kWall},
      {"all classes are obstacles", {{1, kFloor}}, State::Occupied, kFloor},
      {"at the robot's height", {{3, kWall}}, State::Unknown, std::nullopt},
      {"above the band", {{1, kFreeClass}, {5, kWall}}, State::Free, kFreeClass},
      {"below the band", {{0, kWall}, {1, kFreeClass}}, State::Free, kFreeClass}};
  for (const Column& column : columns) {
    std::vector<LabelledVoxel> voxels{{{0, 0, 1}, kFreeClass}};
    for (const auto& [z, k] : column.voxels) voxels.push_back({{1, 0, z}, k});
    const SemanticMap map = mapOf(voxels);
    const NavigationGrid grid(VoxelSelection(map), options);
    ASSERT_EQ(grid.width(), 2) << column.what;
    EXPECT_EQ(grid.state(1, 0), column.state) << column.what;
    EXPECT_EQ(grid.classAt(1, 0), column.class_id) << column.what;
  }
}

TEST(NavigationGrid, GroundIsThatOfTheNearestColumn) {
  // A ramp of two steps, and walls without ground of their own beside each.
  const SemanticMap map = mapOf({{{0, 0, 0}, kFloor},
                                 {{1, 0, 1}, kWall},
                                 {{8, 0, 6}, kWall},
                                 {{9, 0, 6}, kFloor},
                                 {{9, 0, 5}, kWall}});
  NavigationOptions options;
  options.traversable = {kFloor};
  // (9, 0) stands on a wall: its floor is no ground, so (8, 0) is far above that of (0, 0).
  EXPECT_EQ(NavigationGrid(VoxelSelection(map), options).state(8, 0),
            NavigationGrid::State::Unknown);
  const SemanticMap ramp =
      mapOf({{{0, 0, 0}, kFloor}, {{1, 0, 1}, kWall}, {{8, 0, 7}, kWall}, {{9, 0, 6}, kFloor}});
  const NavigationGrid grid(VoxelSelection(ramp), options);
  EXPECT_EQ(grid.state(1, 0), NavigationGrid::State::Occupied);
  EXPECT_EQ(grid.state(8, 0), NavigationGrid::State::Occupied);
  EXPECT_EQ(grid.state(5, 0), NavigationGrid::State::Unknown);
}

TEST(NavigationGrid, CoversTheMapAndFollowsTheFrame) {
  const SemanticMap map = mapOf({{{-3, 2, 0}, kFloor}, {{4, 5, 1}, kWall}});
  NavigationOptions options;
  options.traversable = {kFloor};
  const NavigationGrid grid(VoxelSelection(map), options);
  EXPECT_EQ(grid.width(), 8);
  EXPECT_EQ(grid.height(), 4);
  EXPECT_EQ(grid.origin(), Eigen::Vector2d(-1.5, 1));
  EXPECT_EQ(grid.state(0, 0), NavigationGrid::State::Free);
  EXPECT_EQ(grid.state(7, 3), NavigationGrid::State::Occupied);
  EXPECT_EQ(grid.count(NavigationGrid::State::Unknown), 30U);

  // A quarter turn to the left, ten metres up.
  Eigen::Isometry3d pose(Eigen::Translation3d(0, 0, 10));
  pose.rotate(Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitZ()));
  const NavigationGrid turned(VoxelSelection(map, {}, pose), options);
  EXPECT_EQ(turned.width(), 4);
  EXPECT_EQ(turned.height(), 8);
  EXPECT_EQ(turned.origin(), Eigen::Vector2d(-3, -1.5));
  EXPECT_EQ(turned.state(3, 0), NavigationGrid::State::Free);
  EXPECT_EQ(turned.state(0, 7), NavigationGrid::State::Occupied);
}

TEST(NavigationGrid, SaysWhyThereIsNone) {
  const SemanticMap map = mapOf({{{0, 0, 0}, kFloor}, {{1, 0, 1}, kWall}});
  const auto errorOf = [](const SemanticMap& of, const NavigationOptions& options) -> std::string {
    try {
      NavigationGrid(VoxelSelection(of), options);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no error";
  };
  NavigationOptions options;
  EXPECT_THAT(errorOf(map, options), HasSubstr("name the classes to drive on"));
  options.traversable = {kRug};
  EXPECT_THAT(errorOf(map, options), HasSubstr("no column of the map stands on"));
  options.band = {0.6, 2};
  EXPECT_THAT(errorOf(map, options), HasSubstr("no cell would be free"));
  options.band = {7, 8};
  EXPECT_THAT(errorOf(map, options),
              HasSubstr("no voxel of the map lies within the obstacle band"));
  options.band = {2, 1};
  EXPECT_THAT(errorOf(map, options), HasSubstr("band must begin below its end"));
  options.band = {0, 1};
  options.robot_height = 0;
  EXPECT_THAT(errorOf(map, options), HasSubstr("robot's height"));
  options.robot_height = 1;
  const SemanticMap wide = mapOf({{{0, 0, 0}, kFloor}, {{100000, 100000, 0}, kFloor}});
  EXPECT_THAT(errorOf(wide, options), HasSubstr("100001 x 100001 cells"));
  EXPECT_THAT(errorOf(SemanticMap(), options), HasSubstr("the map is empty"));
}

}  // namespace
}  // namespace csom::test
