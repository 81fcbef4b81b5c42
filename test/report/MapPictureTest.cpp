// SPDX-License-Identifier: BSD-3-Clause
// Pictures of maps, pixel by pixel where it matters.
#include <csom/report/MapPicture.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "ClassColors.h"
#include "SampleMaps.h"

namespace csom {
namespace {

cv::Mat drawn(const MapDocument& document, const MapPictureOptions& options = {},
              MapView view = MapView::Top) {
  return cv::imdecode(mapPicturePng(document, view, options), cv::IMREAD_COLOR);
}

struct Centroid {
  double x = 0;
  double y = 0;
  int pixels = 0;
};

/// Where the pixels of one saturated colour are, the legend on the right excluded.
Centroid find(const cv::Mat& image, int bgr_channel) {
  Centroid found;
  const int right = 20 + 300;  // margin and the smallest panel: the maps of these tests are small
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < std::min(right, image.cols); ++x) {
      const auto& pixel = image.at<cv::Vec3b>(y, x);
      int others = 0;
      for (int c = 0; c < 3; ++c)
        if (c != bgr_channel) others = std::max(others, int(pixel[c]));
      if (pixel[bgr_channel] > 120 && others < 90) {
        found.x += x;
        found.y += y;
        ++found.pixels;
      }
    }
  }
  if (found.pixels > 0) {
    found.x /= found.pixels;
    found.y /= found.pixels;
  }
  return found;
}
constexpr int kBlue = 0;
constexpr int kGreen = 1;
constexpr int kRed = 2;

TEST(MapPictureTest, AnEmptyMapGivesAPicture) {
  const cv::Mat image = drawn(test::mapOf({}));
  ASSERT_FALSE(image.empty());
  double darkest = 255;
  cv::minMaxLoc(image.reshape(1), &darkest, nullptr);
  EXPECT_LT(darkest, 128) << "it should say in words that the map is empty";
}

TEST(MapPictureTest, ASingleVoxelIsVisible) {
  const cv::Mat image = drawn(test::mapOf({{{7, -3, 2}, 2}}));
  EXPECT_GE(find(image, kGreen).pixels, 100);
}

TEST(MapPictureTest, XPointsRightAndYUp) {
  const cv::Mat image = drawn(test::mapOf({{{0, 0, 0}, 1}, {{6, 0, 0}, 2}, {{0, 6, 0}, 3}}));
  const Centroid origin = find(image, kRed);
  const Centroid along_x = find(image, kGreen);
  const Centroid along_y = find(image, kBlue);
  ASSERT_GT(std::min({origin.pixels, along_x.pixels, along_y.pixels}), 0);
  EXPECT_GT(along_x.x, origin.x + 50);
  EXPECT_NEAR(along_x.y, origin.y, 1);
  EXPECT_LT(along_y.y, origin.y - 50);
  EXPECT_NEAR(along_y.x, origin.x, 1);
}

TEST(MapPictureTest, LooksDownTheAxisThatIsUp) {
  // In the frame of a camera y points down and z forward: −y is up, x right, z to the top.
  MapPictureOptions options;
  options.up = {0.02, -0.99, 0.1};
  const MapDocument map =
      test::mapOf({{{0, 0, 0}, 1}, {{6, 0, 0}, 2}, {{0, 0, 6}, 3}, {{0, 5, 6}, 1}});
  const cv::Mat image = drawn(map, options);
  const Centroid origin = find(image, kRed);
  const Centroid along_x = find(image, kGreen);
  const Centroid along_z = find(image, kBlue);
  ASSERT_GT(std::min({origin.pixels, along_x.pixels, along_z.pixels}), 0);
  EXPECT_GT(along_x.x, origin.x + 50);
  EXPECT_NEAR(along_x.y, origin.y, 1);
  EXPECT_LT(along_z.y, origin.y - 50);
  EXPECT_NEAR(along_z.x, origin.x, 1) << "the red voxel below it is hidden";

  options.up = -Eigen::Vector3d::UnitY();
  options.highest = -1.0;  // what lies above y = 1 m is cut away
  EXPECT_EQ(find(drawn(map, options), kGreen).pixels, 0);
}

TEST(MapPictureTest, TheTopmostOccupiedVoxelOfAColumnIsShown) {
  const cv::Mat image = drawn(test::mapOf({{{0, 0, 3}, 2}, {{0, 0, 0}, 1}, {{0, 0, 5}, 0}}));
  EXPECT_GT(find(image, kGreen).pixels, 0);
  EXPECT_EQ(find(image, kRed).pixels, 0);
}

TEST(MapPictureTest, CeilingsAreLookedThrough) {
  const MapDocument room = test::mapOf({{{0, 0, 0}, 1}, {{0, 0, 3}, 4}});
  EXPECT_GT(find(drawn(room), kRed).pixels, 0);
  MapPictureOptions with_ceiling;
  with_ceiling.hidden_classes.clear();
  EXPECT_EQ(find(drawn(room, with_ceiling), kRed).pixels, 0);
}

TEST(MapPictureTest, TheLegendNamesWhatIsLeftOut) {
  // "ceiling (not drawn)" is wider than every other entry.
  EXPECT_GT(drawn(test::mapOf({{{0, 0, 0}, 1}, {{0, 0, 3}, 4}})).cols,
            drawn(test::mapOf({{{0, 0, 0}, 1}})).cols);
}

TEST(MapPictureTest, HighestZCutsByTheCentresOfVoxels) {
  const MapDocument tower = test::mapOf({{{0, 0, 0}, 1}, {{0, 0, 3}, 2}});
  MapPictureOptions options;
  options.highest = 3.5;
  EXPECT_GT(find(drawn(tower, options), kGreen).pixels, 0);
  options.highest = 3.4;
  EXPECT_EQ(find(drawn(tower, options), kGreen).pixels, 0);
  EXPECT_GT(find(drawn(tower, options), kRed).pixels, 0);
  options.highest = -5;
  EXPECT_FALSE(drawn(tower, options).empty());
}

TEST(MapPictureTest, HigherVoxelsOfAClassAreLighter) {
  std::vector<test::LabelledVoxel> steps;
  for (int x = 0; x < 10; ++x)
    for (int y = 0; y < 10; ++y) steps.push_back({{x, y, x < 5 ? 0 : 20}, 1});
  const cv::Mat image = drawn(test::mapOf(steps));
  // Ten voxels of 24 pixels, centred in the panel.
  const int middle = 20 + 300 / 2;
  const int y = 20 + 120;
  const auto low = image.at<cv::Vec3b>(y, middle - 100);
  const auto high = image.at<cv::Vec3b>(y, middle + 100);
  EXPECT_GT(high[kRed] + high[kBlue] + high[kGreen], low[kRed] + low[kBlue] + low[kGreen] + 20);
}

TEST(MapPictureTest, FreeSpaceIsGrayAndUnknownIsWhite) {
  const cv::Mat image = drawn(test::mapOf({{{0, 0, 0}, 1}, {{2, 0, 0}, 0}}));
  const int y = 20 + (image.rows - 20 - 84) / 2;
  const int left = 20 + (300 - 3 * 24) / 2;
  const auto unknown = image.at<cv::Vec3b>(y, left + 24 + 12);
  const auto free_space = image.at<cv::Vec3b>(y, left + 2 * 24 + 12);
  EXPECT_EQ(unknown, cv::Vec3b(255, 255, 255));
  EXPECT_LT(free_space[0], 250);
  EXPECT_EQ(free_space[0], free_space[1]);
  EXPECT_EQ(free_space[1], free_space[2]);
}

TEST(MapPictureTest, ThePictureOfAHugeMapIsBounded) {
  const std::int32_t far = kMaxVoxelIndex;
  MapPictureOptions options;
  options.max_pixels = 500;
  const cv::Mat image =
      drawn(test::mapOf({{{-far, -far, 0}, 1}, {{far, far, 0}, 2}, {{0, 0, 0}, 3}}), options);
  EXPECT_LE(image.cols, 500 + 400);
  EXPECT_LE(image.rows, 500 + 200);
}

TEST(MapPictureTest, LongAndNarrowMapsFit) {
  std::vector<test::LabelledVoxel> corridor;
  for (int x = 0; x < 3000; ++x) corridor.push_back({{x, 0, 0}, 1});
  const cv::Mat image = drawn(test::mapOf(corridor, 0.2));
  EXPECT_GT(image.cols, 900);
  EXPECT_LT(image.cols, 1700);
  EXPECT_LT(image.rows, 600);
}

TEST(MapPictureTest, ManyClassesAndHostileNamesFitIntoTheLegend) {
  std::string yaml = "name: many\nclasses:\n  - {id: 0, name: free, color: [255, 255, 255]}\n";
  std::vector<test::LabelledVoxel> voxels;
  for (int k = 1; k < 200; ++k) {
    const std::string name = "'" + std::string(200, 'x') + "<é%s" + std::to_string(k) + "'";
    yaml += "  - {id: " + std::to_string(k) + ", name: " + name + ", color: [9, 9, " +
            std::to_string(k) + "]}\n";
    voxels.push_back({{k, 0, 0}, static_cast<ClassId>(k)});
  }
  const cv::Mat image = drawn(test::mapOf(voxels, 1.0, LabelSet::fromYaml(yaml, "many")));
  EXPECT_LT(image.rows, 1000);
  EXPECT_LT(image.cols, 2000);
}

TEST(MapPictureTest, TheFrontShowsWhatIsNearestWithUpToTheTop) {
  const cv::Mat image =
      drawn(test::mapOf({{{0, 0, 0}, 1}, {{6, 3, 0}, 2}, {{0, 0, 6}, 3}, {{0, 9, 0}, 2}}), {},
            MapView::Front);
  const Centroid origin = find(image, kRed);
  const Centroid along_x = find(image, kGreen);
  const Centroid along_z = find(image, kBlue);
  ASSERT_GT(std::min({origin.pixels, along_x.pixels, along_z.pixels}), 0);
  EXPECT_GT(along_x.x, origin.x + 50);
  EXPECT_NEAR(along_x.y, origin.y, 1) << "the green voxel behind the red one is hidden";
  EXPECT_LT(along_z.y, origin.y - 50);
  EXPECT_NEAR(along_z.x, origin.x, 1);
}

TEST(MapPictureTest, TheSideLooksAgainstX) {
  const cv::Mat image =
      drawn(test::mapOf({{{0, 0, 0}, 2}, {{4, 0, 0}, 1}, {{0, 6, 0}, 3}}), {}, MapView::Side);
  const Centroid nearest = find(image, kRed);
  const Centroid along_y = find(image, kBlue);
  ASSERT_GT(std::min(nearest.pixels, along_y.pixels), 0);
  EXPECT_EQ(find(image, kGreen).pixels, 0) << "it is behind the red one";
  EXPECT_GT(along_y.x, nearest.x + 50);
  EXPECT_NEAR(along_y.y, nearest.y, 1);
}

TEST(MapPictureTest, IsometricAxesPointToTheRightTheLeftAndUp) {
  const cv::Mat image =
      drawn(test::mapOf({{{0, 0, 0}, 1}, {{5, 0, 0}, 2}, {{0, 5, 0}, 3}}), {}, MapView::Isometric);
  const Centroid origin = find(image, kRed);
  const Centroid along_x = find(image, kGreen);
  const Centroid along_y = find(image, kBlue);
  ASSERT_GT(std::min({origin.pixels, along_x.pixels, along_y.pixels}), 0);
  // Five edges of 24 pixels: cos 45° across, and a half of tan 30° of that upwards.
  EXPECT_NEAR(along_x.x - origin.x, 5 * 24 * std::sqrt(0.5), 1);
  EXPECT_NEAR(origin.y - along_x.y, 5 * 24 * std::sqrt(1 / 6.), 1);
  EXPECT_NEAR(origin.x - along_y.x, 5 * 24 * std::sqrt(0.5), 1);
  EXPECT_NEAR(origin.y - along_y.y, 5 * 24 * std::sqrt(1 / 6.), 1);
  // A hexagon: three rhombi of an area of √3/3 edges².
  EXPECT_NEAR(origin.pixels, std::sqrt(3.) * 24 * 24, 60);
}

TEST(MapPictureTest, IsometricHidesExactlyWhatIsBehind) {
  // The second one lies behind the first along the line of sight; the third half beside it.
  const auto pixels = [](const std::vector<test::LabelledVoxel>& voxels, int channel) {
    return find(drawn(test::mapOf(voxels), {}, MapView::Isometric), channel).pixels;
  };
  const int whole = pixels({{{0, 0, 0}, 2}}, kGreen);
  EXPECT_EQ(pixels({{{0, 0, 0}, 1}, {{2, 2, -2}, 2}}, kGreen), 0);
  EXPECT_NEAR(pixels({{{0, 0, 1}, 1}, {{0, 0, 0}, 2}}, kGreen), 2 * whole / 3, 30);
  EXPECT_NEAR(pixels({{{0, 0, 1}, 1}, {{0, 0, 0}, 2}}, kRed), whole, 30);
}

TEST(MapPictureTest, EveryViewOfAHugeMapIsBounded) {
  const std::int32_t far = kMaxVoxelIndex;
  MapPictureOptions options;
  options.max_pixels = 300;
  const MapDocument document = test::mapOf(
      {{{-far, -far, -far}, 1}, {{far, far, far}, 2}, {{far, -far, -far}, 3}, {{0, 0, 0}, 3}});
  for (const MapView view : kMapViews) {
    const cv::Mat image = drawn(document, options, view);
    EXPECT_LE(image.cols, 300 + 400) << toString(view);
    EXPECT_LE(image.rows, 300 + 200) << toString(view);
  }
}

TEST(MapPictureTest, ColoursForColourBlindEyesAreFarFromOneAnother) {
  std::string yaml = "name: many\nclasses:\n  - {id: 0, name: free, color: [255, 255, 255]}\n";
  std::vector<test::LabelledVoxel> voxels;
  for (int k = 1; k < 22; ++k) {
    yaml += "  - {id: " + std::to_string(k) + ", name: c" + std::to_string(k) + ", color: [9, 9, " +
            std::to_string(k) + "]}\n";
    for (int i = 0; i < k; ++i) voxels.push_back({{k, i, 0}, static_cast<ClassId>(k)});
  }
  const std::vector<Color> colors =
      colorBlindSafeColors(test::mapOf(voxels, 1.0, LabelSet::fromYaml(yaml, "many")));
  ASSERT_EQ(colors.size(), 22u);
  EXPECT_EQ(colors[21], (Color{0, 114, 178})) << "the largest class has the first colour";
  for (std::size_t a = 1; a < colors.size(); ++a) {
    for (std::size_t b = 1; b < a; ++b) {
      int distance = 0;
      for (std::size_t c = 0; c < 3; ++c) distance += std::abs(colors[a][c] - colors[b][c]);
      EXPECT_GT(distance, 40) << a << " and " << b;
    }
  }
}

TEST(MapPictureTest, PicturesTakeTheColoursForColourBlindEyes) {
  MapPictureOptions options;
  options.color_blind_safe = true;
  for (const MapView view : kMapViews) {
    const cv::Mat image = drawn(test::mapOf({{{0, 0, 0}, 1}}), options, view);
    EXPECT_EQ(find(image, kRed).pixels, 0) << toString(view);
    int bluish = 0;
    for (const auto& pixel : cv::Mat_<cv::Vec3b>(image))
      if (pixel[kBlue] > pixel[kGreen] + 30 && pixel[kGreen] > pixel[kRed] + 30) ++bluish;
    EXPECT_GT(bluish, 400) << toString(view);
  }
}

TEST(MapPictureTest, TheSameMapGivesTheSameBytes) {
  const MapDocument document = test::mapOf({{{0, 0, 0}, 1}, {{6, 0, 0}, 2}});
  for (const MapView view : kMapViews)
    EXPECT_EQ(mapPicturePng(document, view), mapPicturePng(document, view));
}

TEST(MapPictureTest, UnreasonableSizesAreRefused) {
  const MapDocument document = test::mapOf({{{0, 0, 0}, 1}});
  for (const int pixels : {-1, 0, 63, 4097}) {
    MapPictureOptions options;
    options.max_pixels = pixels;
    EXPECT_THROW(mapPicturePng(document, MapView::Top, options), std::invalid_argument) << pixels;
  }
}

}  // namespace
}  // namespace csom
