// SPDX-License-Identifier: BSD-3-Clause
// MRPT's icp-slam with the semantic map as its only map.
#include <mrpt/maps/CSimpleMap.h>

#include <cmath>
#include <iostream>

#include "apps/RunMrpt.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

const std::string kConfig = CSOM_SOURCE_DIR "/config/mrpt/icp-slam.ini";
const std::string kLog =
    "/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog";

struct Pose {
  double x = 0;
  double y = 0;
  double heading = 0;  ///< [rad]
};

/// Runs icp-slam in `folder` and returns the last line of the path that it writes.
Pose finalPose(const TempFolder& folder, const std::string& ini) {
  const ProgramResult run = runMrpt(folder.path(), {"icp-slam", ini, kLog});
  if (run.exit_code != 0) throw std::runtime_error(run.output + run.errors);
  std::ifstream path(folder / "icp-slam-out/log_estimated_path.txt");
  Pose pose;
  int poses = 0;
  for (double step = 0; path >> step >> pose.x >> pose.y >> pose.heading;) ++poses;
  if (poses < 200) throw std::runtime_error("icp-slam stopped too early: " + run.output);
  return pose;
}

/// The same ini with MRPT's own points map instead.
std::string withStockMap(const std::string& ini) {
  const std::size_t at = ini.find("semanticPointsMap_count = 1");
  if (at == std::string::npos) throw std::runtime_error("no semanticPointsMap in the ini");
  return ini.substr(0, at) +
         "pointsMap_count = 1\n[MappingApplication_pointsMap_00_insertOpts]\n"
         "minDistBetweenLaserPoints = 0.05\nfuseWithExisting = false\nisPlanarMap = 1\n";
}

TEST(IcpSlam, EndsWhereItEndsWithAStockPointsMap) {
  const TempFolder folder;
  const Pose ours = finalPose(folder, kConfig);
  const MapDocument document =
      loadMap(folder / "icp-slam-out/_finalmaps_.txt_csom__CSemanticPointsMap_00.csom");
  mrpt::maps::CSimpleMap frames;
  ASSERT_TRUE(frames.loadFromFile(folder / "icp-slam-out/_finalmap_.simplemap"));
  EXPECT_EQ(document.scans.size(), frames.size()) << "an observation a frame";
  EXPECT_GT(document.scans.size(), 20u);
  EXPECT_GT(document.map.knownVoxelCount(), 1000u);
  EXPECT_EQ(document.map.options().resolution, 0.05);

  const TempFolder stock_folder;
  writeBytes(stock_folder / "stock.ini", withStockMap(readBytes(kConfig)));
  const Pose stock = finalPose(stock_folder, "stock.ini");
  const double apart = std::hypot(ours.x - stock.x, ours.y - stock.y);
  const double turned = std::remainder(ours.heading - stock.heading, 2 * M_PI) * 180 / M_PI;
  std::cout << "final poses " << apart << " m and " << turned << " degrees apart\n";
  EXPECT_GT(std::hypot(stock.x, stock.y), 10) << "the drive leads somewhere";
  EXPECT_LT(apart, 0.5);
  EXPECT_LT(std::abs(turned), 3);
}

// docs/mrpt.md tells users so.
TEST(IcpSlam, RefusesTheMapThatIsNoPointsMap) {
  const TempFolder folder;
  std::string ini = readBytes(kConfig);
  for (std::size_t at = 0; (at = ini.find("semanticPointsMap", at)) != std::string::npos;)
    ini.replace(at, 17, "semanticContinuousMap");
  writeBytes(folder / "alone.ini", ini);
  const ProgramResult run = runMrpt(folder.path(), {"icp-slam", "alone.ini", kLog});
  EXPECT_NE(run.exit_code, 0);
  EXPECT_THAT(run.output + run.errors, testing::HasSubstr("Neither grid maps nor points map"));
}

}  // namespace
}  // namespace csom::test
