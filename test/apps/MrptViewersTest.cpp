// SPDX-License-Identifier: BSD-3-Clause
// MRPT's programs with windows: SceneViewer3D shows scenes that maps save, RawLogViewer reads logs
// with maps in them.
#include <csom/maps/CSemanticContinuousMap.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <filesystem>

#include "apps/RunMrpt.h"
#include "apps/VirtualDisplay.h"
#include "io/IoFixtures.h"
#include "maps/SampleObservations.h"

namespace csom::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class MrptViewers : public testing::Test {
 protected:
  MrptViewers() : display_(folder_.path()) {}

  BackgroundProgram start(const std::vector<std::string>& command,
                          std::vector<std::string> environment = {}) {
    environment.insert(environment.begin(),
                       {"DISPLAY=" + display_.name(), "HOME=" + folder_.path(), "LC_ALL=C"});
    return BackgroundProgram(command, environment, folder_ / "printed.txt");
  }
  std::string printed() const { return readBytes(folder_ / "printed.txt"); }

  /// Pixels that are clearly greener than red or blue: no program draws anything in that colour.
  long greenPixels() const {
    const auto pixels = display_.pixels();
    return std::count_if(pixels.begin(), pixels.end(), [](const VirtualDisplay::Pixel& pixel) {
      return pixel.green > 60 && pixel.green > 2 * pixel.red && pixel.green > 2 * pixel.blue;
    });
  }
  bool showsAnything() const {
    const auto pixels = display_.pixels();
    return std::any_of(pixels.begin(), pixels.end(),
                       [](const VirtualDisplay::Pixel& pixel) { return pixel.green > 100; });
  }

  const TempFolder folder_;
  VirtualDisplay display_;
};

TEST_F(MrptViewers, SceneViewerShowsTheSceneThatAMapSaves) {
  CSemanticContinuousMap map = csom::sample::roomMap();  // walls of a green class
  map.renderingOptions.save_scene = true;
  map.saveMetricMapRepresentationToFile(folder_ / "room");
  auto viewer = start({"SceneViewer3D", folder_ / "room.3Dscene"});
  EXPECT_TRUE(eventually([&] { return greenPixels() > 300 || !viewer.isRunning(); }));
  EXPECT_TRUE(viewer.isRunning());
  EXPECT_GT(greenPixels(), 300) << printed();
}

TEST_F(MrptViewers, SceneViewerLoadsThePlugin) {
  auto viewer = start({"SceneViewer3D", "-l", CSOM_PLUGIN}, acceptingPlugin());
  EXPECT_TRUE(eventually([&] { return showsAnything() || !viewer.isRunning(); }));
  EXPECT_TRUE(viewer.isRunning()) << printed();
  EXPECT_TRUE(viewer.hasLoaded("libcsom-maps.so"));
}

/// A log with one laser scan and the map of it.
void writeLogWithMap(const std::string& file) {
  mrpt::io::CFileGZOutputStream stream(file);
  auto archive = mrpt::serialization::archiveFrom(stream);
  const auto scan = csom::sample::laserScan();
  scan->timestamp = mrpt::Clock::fromDouble(1.5e9);
  CSemanticContinuousMap map;
  map.insertObservation(*scan);
  archive << *scan << map;
}

TEST_F(MrptViewers, RawLogViewerLoadsThePluginAndReadsALogWithAMap) {
  writeLogWithMap(folder_ / "map.rawlog");
  auto viewer =
      start({"RawLogViewer", "-l", CSOM_PLUGIN, folder_ / "map.rawlog"}, acceptingPlugin());
  EXPECT_TRUE(eventually([&] { return showsAnything() || !viewer.isRunning(); }));
  EXPECT_TRUE(viewer.isRunning()) << printed();
  EXPECT_TRUE(viewer.hasLoaded("libcsom-maps.so"));
  EXPECT_THAT(printed(), Not(HasSubstr("not registered")));
}

}  // namespace
}  // namespace csom::test
