// SPDX-License-Identifier: BSD-3-Clause
// Navigation maps, read back by MRPT (grid) and OpenCV (classes).
#include <csom/exports/NavigationFiles.h>
#include <mrpt/maps/COccupancyGridMap2D.h>

#include <opencv2/imgcodecs.hpp>

#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::HasSubstr;
using State = NavigationGrid::State;

NavigationGrid sampleGrid(const SemanticMap& map) {
  NavigationOptions options;
  options.traversable = {1};
  options.robot_height = 0.6;
  return NavigationGrid(VoxelSelection(map), options);
}

class NavigationFilesTest : public testing::Test {
 protected:
  const SemanticMap map_ = sampleMap();
  const NavigationGrid grid_ = sampleGrid(map_);
  const LabelSet labels_ = sampleLabels();
  TempFolder folder_;
};

TEST_F(NavigationFilesTest, SampleHasAllStates) {
  for (const State state : {State::Free, State::Occupied, State::Unknown})
    EXPECT_GT(grid_.count(state), 3U);
}

TEST_F(NavigationFilesTest, MrptReadsTheGrid) {
  writeNavigationFiles(grid_, labels_, NavigationFiles::named(folder_ / "it's.yaml"));
  const auto read = mrpt::maps::COccupancyGridMap2D::FromROSMapServerYAML(folder_ / "it's.yaml");
  ASSERT_EQ(read.getSizeX(), static_cast<unsigned>(grid_.width()));
  ASSERT_EQ(read.getSizeY(), static_cast<unsigned>(grid_.height()));
  EXPECT_NEAR(read.getResolution(), 0.25, 1e-6);
  EXPECT_NEAR(read.getXMin(), grid_.origin().x(), 1e-6);
  EXPECT_NEAR(read.getYMin(), grid_.origin().y(), 1e-6);
  for (int y = 0; y < grid_.height(); ++y)
    for (int x = 0; x < grid_.width(); ++x) {
      const float free = read.getCell(x, y);
      switch (grid_.state(x, y)) {
        case State::Free:
          EXPECT_GT(free, 0.95F);
          break;
        case State::Occupied:
          EXPECT_LT(free, 0.05F);
          break;
        case State::Unknown:
          EXPECT_NEAR(free, 0.5F, 0.01F);
          break;
      }
    }
}

TEST_F(NavigationFilesTest, OpenCvReadsTheClasses) {
  const NavigationFiles files = NavigationFiles::named(folder_ / "map.yaml");
  writeNavigationFiles(grid_, labels_, files);
  const cv::Mat image = cv::imread(files.classes, cv::IMREAD_UNCHANGED);
  ASSERT_EQ(image.type(), CV_8UC4);
  ASSERT_EQ(image.cols, grid_.width());
  ASSERT_EQ(image.rows, grid_.height());
  for (int y = 0; y < grid_.height(); ++y)
    for (int x = 0; x < grid_.width(); ++x) {
      const auto pixel = image.at<cv::Vec4b>(grid_.height() - 1 - y, x);
      const auto class_id = grid_.classAt(x, y);
      ASSERT_EQ(pixel[3], class_id ? 255 : 0);
      if (!class_id) continue;
      EXPECT_EQ((Color{pixel[2], pixel[1], pixel[0]}), labels_.at(*class_id).color);
    }
}

TEST_F(NavigationFilesTest, NamesFilesBesideTheYamlFile) {
  const NavigationFiles files = NavigationFiles::named("a.b/c.d.yaml");
  EXPECT_EQ(files.yaml, "a.b/c.d.yaml");
  EXPECT_EQ(files.image, "a.b/c.d.pgm");
  EXPECT_EQ(files.classes, "a.b/c.d_classes.png");
  for (const char* wrong : {"", "map", "map.pgm", ".yaml", "a/.yaml", "map.yaml/"})
    EXPECT_THROW(NavigationFiles::named(wrong), ConfigError) << wrong;
}

TEST_F(NavigationFilesTest, FailuresLeaveNothing) {
  EXPECT_THAT(fileErrorOf([&] {
                writeNavigationFiles(grid_, labels_, NavigationFiles::named("/nowhere/m.yaml"));
              }),
              HasSubstr("/nowhere/m.pgm: cannot be written"));
  // The last of the three cannot be replaced.
  std::filesystem::create_directory(folder_ / "m.yaml");
  EXPECT_THAT(fileErrorOf([&] {
                writeNavigationFiles(grid_, labels_, NavigationFiles::named(folder_ / "m.yaml"));
              }),
              HasSubstr("m.yaml: is a folder"));
  EXPECT_THAT(folder_.fileNames(), testing::ElementsAre("m.yaml"));
}

}  // namespace
}  // namespace csom::test
