// SPDX-License-Identifier: BSD-3-Clause
// Images of class ids.
#include <csom/vision/SemanticImage.h>
#include <gmock/gmock.h>

#include <stdexcept>

namespace csom::test {
namespace {

using Eigen::Vector2d;
using testing::ElementsAre;

/// Raw ids 10 and 300 have classes, 0 is ignored, nobody knows the others.
ClassId classOf(std::uint32_t raw) {
  if (raw == 10) return 1;
  if (raw == 300) return 2;
  return raw == 0 ? kIgnoredPixel : kUnknownPixel;
}

const cv::Mat kRaw8 = (cv::Mat_<std::uint8_t>(2, 3) << 10, 0, 7, 10, 10, 0);
const cv::Mat kRaw16 = (cv::Mat_<std::uint16_t>(2, 3) << 300, 0, 65535, 10, 300, 0);

TEST(LabelImage, MapsEightBitIds) {
  const LabelImage image(kRaw8, classOf);
  EXPECT_EQ(image.size(), cv::Size(3, 2));
  const cv::Mat classes = image.classes();
  ASSERT_EQ(classes.type(), CV_16UC1);
  const std::vector<ClassId> ids(classes.begin<ClassId>(), classes.end<ClassId>());
  EXPECT_THAT(ids, ElementsAre(1, kIgnoredPixel, kUnknownPixel, 1, 1, kIgnoredPixel));
}

TEST(LabelImage, MapsSixteenBitIds) {
  const cv::Mat classes = LabelImage(kRaw16, classOf).classes();
  const std::vector<ClassId> ids(classes.begin<ClassId>(), classes.end<ClassId>());
  EXPECT_THAT(ids, ElementsAre(2, kIgnoredPixel, kUnknownPixel, 1, 2, kIgnoredPixel));
}

TEST(LabelImage, ReadsRowsThatHaveGapsBetweenThem) {
  const LabelImage image(kRaw8(cv::Rect(1, 0, 2, 2)), classOf);
  EXPECT_EQ(image.classAt({0, 0}).id, kIgnoredPixel);
  EXPECT_EQ(image.classAt({0, 1}).id, 1);
}

TEST(LabelImage, NearestPixelCountsUpToTheBorder) {
  const LabelImage image(kRaw16, classOf);
  EXPECT_EQ(image.classAt({0.49, 0.49}).id, 2);
  EXPECT_EQ(image.classAt({0.49, 0.51}).id, 1);
  EXPECT_EQ(image.classAt({0.51, 0.49}).id, kIgnoredPixel);
  EXPECT_EQ(image.classAt({-0.5, -0.5}).id, 2);
  EXPECT_EQ(image.classAt({2.5, 1.5}).id, kIgnoredPixel);
  EXPECT_EQ(image.classAt({2.5, -0.5}).id, kUnknownPixel);
}

TEST(LabelImage, IsSureOfAClassAndOfNothingElse) {
  const LabelImage image(kRaw16, classOf);
  EXPECT_EQ(image.classAt({0, 1}).confidence, 1);
  EXPECT_EQ(image.classAt({1, 0}).confidence, 0);
  EXPECT_EQ(image.classAt({2, 0}).confidence, 0);

  std::vector<float> scores{9, 9, 9};
  EXPECT_EQ(image.scoresAt({0, 1}, 5, scores).id, 1);
  EXPECT_THAT(scores, ElementsAre(0, 1, 0));
  EXPECT_EQ(image.scoresAt({1, 0}, 5, scores).id, kIgnoredPixel);
  EXPECT_THAT(scores, ElementsAre(0, 0, 0));
  std::vector<float> too_few(2);
  EXPECT_THROW(image.scoresAt({0, 0}, 1, too_few), std::out_of_range);
}

TEST(LabelImage, DoesNotShareMemoryWithItsSource) {
  cv::Mat raw = kRaw8.clone();
  const LabelImage image(raw, classOf);
  raw = 0;
  image.classes().setTo(9);
  EXPECT_EQ(image.classAt({0, 0}).id, 1);
  EXPECT_EQ(image.raw().at<std::uint8_t>(0, 0), 10);
}

TEST(LabelImage, RefusesOtherImages) {
  EXPECT_THROW(LabelImage(cv::Mat(), classOf), std::invalid_argument);
  EXPECT_THROW(LabelImage(cv::Mat::zeros(2, 2, CV_8UC3), classOf), std::invalid_argument);
  EXPECT_THROW(LabelImage(cv::Mat::zeros(2, 2, CV_32FC1), classOf), std::invalid_argument);
}

}  // namespace
}  // namespace csom::test
