// SPDX-License-Identifier: BSD-3-Clause
// Maps of MRPT's types, read back by MRPT and by one of its programs.
#include <csom/mrpt_exports/MrptFiles.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/serialization/CArchive.h>

#include "apps/RunCsom.h"
#include "eval/LabelledVoxels.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::HasSubstr;
using State = NavigationGrid::State;

template <class Object>
typename Object::Ptr readObject(const std::string& file) {
  mrpt::io::CFileGZInputStream stream(file);
  return std::dynamic_pointer_cast<Object>(mrpt::serialization::archiveFrom(stream).ReadObject());
}

NavigationGrid gridOf(const SemanticMap& map) {
  NavigationOptions options;
  options.traversable = {1};
  return NavigationGrid(VoxelSelection(map), options);
}

TEST(MrptFiles, MrptReadsTheGridMap) {
  const TempFolder folder;
  const NavigationGrid grid = gridOf(sampleMap());
  writeGridmap(grid, folder / "map.gridmap");
  const auto map = readObject<mrpt::maps::COccupancyGridMap2D>(folder / "map.gridmap");
  ASSERT_TRUE(map);
  ASSERT_EQ(map->getSizeX(), static_cast<unsigned>(grid.width()));
  ASSERT_EQ(map->getSizeY(), static_cast<unsigned>(grid.height()));
  EXPECT_EQ(map->getXMin(), static_cast<float>(grid.origin().x()));
  EXPECT_EQ(map->getYMin(), static_cast<float>(grid.origin().y()));
  EXPECT_EQ(map->getResolution(), 0.25F);
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) {
      const State state = grid.state(x, y);
      EXPECT_NEAR(map->getCell(x, y),
                  state == State::Free       ? 0.99
                  : state == State::Occupied ? 0.01
                                             : 0.5,
                  0.01);
    }
  for (const State state : {State::Free, State::Occupied, State::Unknown})
    EXPECT_GT(grid.count(state), 3U);
}

// simul-gridmap measures the distances to the walls of a grid map.
TEST(MrptFiles, StockApplicationMeasuresTheGridMap) {
  const TempFolder folder;
  std::vector<LabelledVoxel> voxels;
  for (int y = -10; y <= 10; ++y)
    for (int x = -20; x <= 30; ++x) {
      const bool border = std::abs(y) == 10 || x == -20 || x == 30;
      voxels.push_back({{x, y, border ? 1 : 0}, static_cast<ClassId>(border ? 2 : 1)});
    }
  writeGridmap(gridOf(mapOf(voxels, 0.1)), folder / "box.gridmap");
  writeBytes(folder / "poses.txt", "0 0.05 0.05 0\n1 0.05 0.05 0\n");
  const ProgramResult run = runProgram(
      folder.path(), "simul-gridmap",
      {"-n", "-g", folder / "box.gridmap", "-p", folder / "poses.txt", "-o", folder / "scan.rawlog",
       "-s", "180", "-r", "181", "-R", "0.0001", "-B", "0.0001"});
  ASSERT_EQ(run.exit_code, 0) << run.output << run.errors;

  mrpt::obs::CRawlog log;
  ASSERT_TRUE(log.loadFromRawLogFile(folder / "scan.rawlog"));
  mrpt::obs::CObservation2DRangeScan::Ptr scan;
  for (std::size_t i = 0; i < log.size() && !scan; ++i) {
    if (log.getType(i) == mrpt::obs::CRawlog::etSensoryFrame)
      scan = log.getAsObservations(i)->getObservationByClass<mrpt::obs::CObservation2DRangeScan>();
    else if (log.getType(i) == mrpt::obs::CRawlog::etObservation)
      scan = std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(log.getAsObservation(i));
  }
  ASSERT_TRUE(scan);
  ASSERT_EQ(scan->getScanSize(), 181U);
  EXPECT_NEAR(scan->getScanRange(0), 0.95, 0.1);    // to the right
  EXPECT_NEAR(scan->getScanRange(90), 2.95, 0.1);   // ahead
  EXPECT_NEAR(scan->getScanRange(180), 0.95, 0.1);  // to the left
}

TEST(MrptFiles, MrptReadsThePoints) {
  const TempFolder folder;
  const SemanticMap map = sampleMap();
  const VoxelSelection voxels(map);
  EXPECT_EQ(writePointMap(voxels, sampleLabels(), folder / "map.points"), voxels.count());
  const auto points = readObject<mrpt::maps::CPointsMapXYZI>(folder / "map.points");
  ASSERT_TRUE(points);
  ASSERT_EQ(points->size(), voxels.count());
  std::size_t i = 0;
  voxels.forEach([&](const VoxelIndex&, const ExportedVoxel& v) {
    float x = 0, y = 0, z = 0;
    points->getPoint(i, x, y, z);
    EXPECT_EQ(Eigen::Vector3f(x, y, z), v.center.cast<float>());
    EXPECT_EQ(points->getPointIntensity(i++), v.class_id);
  });
}

TEST(MrptFiles, RefusesWhatSinglePrecisionCannotHold) {
  const TempFolder folder;
  const SemanticMap map = sampleMap();
  const VoxelSelection far(map, {}, Eigen::Isometry3d(Eigen::Translation3d(4e6, 0, 0)));
  EXPECT_THROW(writePointMap(far, sampleLabels(), folder / "a"), ConfigError);
  NavigationOptions options;
  options.traversable = {1};
  EXPECT_THROW(writeGridmap(NavigationGrid(far, options), folder / "a"), ConfigError);
  EXPECT_THAT(folder.fileNames(), testing::IsEmpty());
}

TEST(MrptFiles, FullDisksAreTold) {
  const SemanticMap map = sampleMap();
  EXPECT_THAT(fileErrorOf([&] { writeGridmap(gridOf(map), "/dev/full"); }),
              HasSubstr("No space left on device"));
  EXPECT_THAT(fileErrorOf([&] { writePointMap(VoxelSelection(map), sampleLabels(), "/dev/full"); }),
              HasSubstr("No space left on device"));
}

}  // namespace
}  // namespace csom::test
