// SPDX-License-Identifier: BSD-3-Clause
// Scores on a grid: quantised, interpolated, turned into classes.
#include <csom/vision/SemanticImage.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>

namespace csom::test {
namespace {

using testing::ElementsAre;
using testing::FloatNear;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// One cell: a logit a channel.
cv::Mat cellOf(const std::vector<float>& logits) {
  const int size[] = {static_cast<int>(logits.size()), 1, 1};
  cv::Mat cell(3, size, CV_32FC1);
  std::copy(logits.begin(), logits.end(), cell.ptr<float>());
  return cell;
}

std::vector<int> distancesOfCell(const std::vector<float>& logits) {
  const cv::Mat distances = ScoreImage::computeDistances(cellOf(logits));
  return {distances.begin<std::uint8_t>(), distances.end<std::uint8_t>()};
}

/// An image of one pixel.
ScoreImage pixelOf(const std::vector<float>& logits, const std::vector<ClassId>& classes) {
  return ScoreImage(ScoreImage::computeDistances(cellOf(logits)), classes, {1, 1}, {});
}

/// Channels that change slowly from cell to cell, or not at all slowly.
cv::Mat randomDistances(int channels, cv::Size grid, bool smooth, unsigned seed) {
  std::mt19937 random(seed);
  const int size[] = {channels, grid.height, grid.width};
  cv::Mat logits(3, size, CV_32FC1);
  for (int channel = 0; channel < channels; ++channel) {
    const double phase = 0.001 * static_cast<double>(random() % 6000);
    for (int y = 0; y < grid.height; ++y) {
      for (int x = 0; x < grid.width; ++x)
        logits.at<float>(channel, y, x) =
            smooth ? static_cast<float>(3 * std::sin(0.2 * x + phase) * std::cos(0.3 * y + phase))
                   : static_cast<float>(random() % 64) / 16;
    }
  }
  return ScoreImage::computeDistances(logits);
}

TEST(ScoreDistances, AreSixteenthsToTheBestChannel) {
  EXPECT_THAT(distancesOfCell({2, 1, 2, 0.5f}), ElementsAre(0, 16, 0, 24));
  EXPECT_THAT(distancesOfCell({0, -0.031f, -0.032f, -0.09f}), ElementsAre(0, 0, 1, 1));
  EXPECT_THAT(distancesOfCell({-1e30f, 1e30f, 100, -100}), ElementsAre(255, 0, 255, 255));
  EXPECT_THAT(distancesOfCell({0, -15.9f, -15.95f, -16}), ElementsAre(0, 254, 255, 255));
}

TEST(ScoreDistances, OfImpossibleChannelsAreTheLargest) {
  EXPECT_THAT(distancesOfCell({-kInfinity, 3, 2}), ElementsAre(255, 0, 16));
}

TEST(ScoreDistances, OfCellsThatAreNotFiniteSayNothing) {
  EXPECT_THAT(distancesOfCell({1, kNan, 2}), ElementsAre(255, 255, 255));
  EXPECT_THAT(distancesOfCell({kNan, 1, 2}), ElementsAre(255, 255, 255));
  EXPECT_THAT(distancesOfCell({1, 2, kInfinity}), ElementsAre(255, 255, 255));
  EXPECT_THAT(distancesOfCell({-kInfinity, -kInfinity}), ElementsAre(255, 255));

  std::vector<float> scores{1, 1};
  EXPECT_EQ(pixelOf({1, kNan}, {0, 1}).scoresAt({0, 0}, 1, scores).id, kUnknownPixel);
  EXPECT_THAT(scores, ElementsAre(0, 0));
}

TEST(ScoreDistances, AreStackedByChannel) {
  const int size[] = {2, 2, 3};
  cv::Mat logits(3, size, CV_32FC1, cv::Scalar(0));
  logits.at<float>(1, 0, 2) = 1;
  logits.at<float>(0, 1, 0) = 2;
  const cv::Mat distances = ScoreImage::computeDistances(logits);
  const std::vector<int> all(distances.begin<std::uint8_t>(), distances.end<std::uint8_t>());
  EXPECT_THAT(all, ElementsAre(0, 0, 16, 0, 0, 0, 0, 0, 0, 32, 0, 0));
}

TEST(ScoreDistances, NeedThreeDimensionsOfFloats) {
  EXPECT_THROW(ScoreImage::computeDistances(cv::Mat::zeros(2, 2, CV_32FC1)), std::invalid_argument);
  const int size[] = {2, 2, 2};
  EXPECT_THROW(ScoreImage::computeDistances(cv::Mat(3, size, CV_64FC1)), std::invalid_argument);
}

TEST(ScoreImage, DistributionIsTheSoftmax) {
  const ScoreImage image = pixelOf({1, 2, 0.5f}, {3, 1, 2});
  const double e1 = std::exp(-1.0);
  const double e2 = std::exp(-1.5);
  const double sum = 1 + e1 + e2;
  std::vector<float> scores(4, 9.0f);
  const PixelClass best = image.scoresAt({0, 0}, 1, scores);
  EXPECT_EQ(best.id, 1);
  EXPECT_NEAR(best.confidence, 1 / sum, 1e-6);
  EXPECT_THAT(scores, ElementsAre(0, FloatNear(static_cast<float>(1 / sum), 1e-6f),
                                  FloatNear(static_cast<float>(e2 / sum), 1e-6f),
                                  FloatNear(static_cast<float>(e1 / sum), 1e-6f)));
  EXPECT_EQ(image.classAt({0, 0}).confidence, best.confidence);
}

TEST(ScoreImage, TemperatureDividesTheLogits) {
  const ScoreImage image = pixelOf({1, 0}, {0, 1});
  std::vector<float> scores(2);
  for (const double temperature : {0.01, 0.5, 1.0, 2.0, 100.0}) {
    const PixelClass best = image.scoresAt({0, 0}, temperature, scores);
    const double expected = 1 / (1 + std::exp(-1 / temperature));
    EXPECT_NEAR(scores[0], expected, 1e-6) << temperature;
    EXPECT_NEAR(scores[1], 1 - expected, 1e-6) << temperature;
    EXPECT_EQ(best.confidence, scores[0]);
  }
  EXPECT_THROW(image.scoresAt({0, 0}, 0, scores), std::invalid_argument);
  EXPECT_THROW(image.scoresAt({0, 0}, kNan, scores), std::invalid_argument);
}

TEST(ScoreImage, ChannelsOfOneClassAddUpButTheBestChannelDecides) {
  // Channels 1 and 2 together say more than channel 0, yet none of them is the best.
  const ScoreImage image = pixelOf({1, 0.75f, 0.75f}, {0, 1, 1});
  std::vector<float> scores(2);
  const PixelClass best = image.scoresAt({0, 0}, 1, scores);
  EXPECT_EQ(best.id, 0);
  const double sum = 1 + 2 * std::exp(-0.25);
  EXPECT_NEAR(scores[0], 1 / sum, 1e-6);
  EXPECT_NEAR(scores[1], 1 - 1 / sum, 1e-6);
  EXPECT_EQ(best.confidence, scores[0]);
}

TEST(ScoreImage, ChannelsWithoutAClassAreTakenOut) {
  const ScoreImage image = pixelOf({1, 0.5f, 0, 0.5f}, {0, kIgnoredPixel, 1, kUnknownPixel});
  std::vector<float> scores(2);
  const PixelClass best = image.scoresAt({0, 0}, 1, scores);
  const double expected = 1 / (1 + std::exp(-1.0));
  EXPECT_EQ(best.id, 0);
  EXPECT_NEAR(best.confidence, expected, 1e-6);
  EXPECT_NEAR(scores[1], 1 - expected, 1e-6);
  EXPECT_EQ(image.classAt({0, 0}).confidence, best.confidence);
}

TEST(ScoreImage, ChannelsWithoutAClassCanWin) {
  for (const ClassId none : {kIgnoredPixel, kUnknownPixel}) {
    const ScoreImage image = pixelOf({0, 1}, {0, none});
    std::vector<float> scores{1, 1};
    EXPECT_EQ(image.classAt({0, 0}).id, none);
    EXPECT_EQ(image.classAt({0, 0}).confidence, 0);
    EXPECT_EQ(image.scoresAt({0, 0}, 1, scores).id, none);
    EXPECT_THAT(scores, ElementsAre(0, 0));
    EXPECT_EQ(image.classes().at<ClassId>(0, 0), none);
  }
}

TEST(ScoreImage, RefusesAClassWithoutAPlace) {
  std::vector<float> scores(2);
  EXPECT_THROW(pixelOf({1, 0}, {0, 2}).scoresAt({0, 0}, 1, scores), std::out_of_range);
}

TEST(ScoreImage, InterpolatesScores) {
  // Two cells a row: channel 0 is better by 4 on the left, channel 1 by 12 on the right.
  const cv::Mat distances = (cv::Mat_<std::uint8_t>(2, 2) << 0, 192, 64, 0);
  const ScoreImage image(distances, {0, 1}, {2, 1}, {});
  // At x the distances are 192·x and 64·(1−x): they meet at x = 1/4.
  EXPECT_EQ(image.classAt({0.24, 0}).id, 0);
  EXPECT_EQ(image.classAt({0.26, 0}).id, 1);
  EXPECT_NEAR(image.classAt({0.25, 0}).confidence, 0.5, 1e-6);
  EXPECT_NEAR(image.classAt({0.5, 0}).confidence, 1 / (1 + std::exp(-4.0)), 1e-6);
  // Beyond the centres of the outer cells their scores stay.
  EXPECT_EQ(image.classAt({-0.5, -0.5}).confidence, image.classAt({0, 0}).confidence);
  EXPECT_EQ(image.classAt({1.5, 0.5}).confidence, image.classAt({1, 0}).confidence);
}

TEST(ScoreImage, PlacesTheGrid) {
  // Four cells over an image of 8 × 8 pixels whose grid begins half a cell to the left.
  const cv::Mat distances = (cv::Mat_<std::uint8_t>(4, 2) << 0, 160, 160, 160, 160, 0, 0, 0);
  const GridPlacement placement{0.25, 0.25, 0.125, -0.375};
  const ScoreImage image(distances, {0, 1}, {8, 8}, placement);
  const auto confidence = [](double x, double y) {
    const double distance_0 = 10 * (1 - (1 - x) * (1 - y));
    return 1 / (1 + std::exp(-std::abs(10 - 2 * distance_0)));
  };
  for (const auto& [u, v] : {std::pair{1.5, 1.5}, {0.5, 3.5}, {3.5, 2.0}, {2.25, 4.75}}) {
    const double x = 0.25 * u + 0.125;
    const double y = 0.25 * v - 0.375;
    EXPECT_NEAR(image.classAt({u, v}).confidence, confidence(x, y), 1e-5) << u << ' ' << v;
  }
}

TEST(ScoreImage, CellsThatSayNothingLeaveTheWordToTheirNeighbours) {
  const cv::Mat distances = (cv::Mat_<std::uint8_t>(2, 2) << 255, 32, 255, 0);
  const ScoreImage image(distances, {0, 1}, {2, 1}, {});
  EXPECT_EQ(image.classAt({0, 0}).id, kUnknownPixel);
  EXPECT_EQ(image.classAt({0.5, 0}).id, 1);
  EXPECT_NEAR(image.classAt({0.5, 0}).confidence, 1 / (1 + std::exp(-1.0)), 1e-6);
  EXPECT_EQ(image.classes().at<ClassId>(0, 0), kUnknownPixel);
}

TEST(ScoreImage, NothingStaysNothingAtAnyWeight) {
  const ScoreImage image(cv::Mat(6, 3, CV_8UC1, cv::Scalar(255)), {0, 1}, {3, 3}, {});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-0.5, 2.5);
  for (int i = 0; i < 2000; ++i)
    ASSERT_EQ(image.classAt({coordinate(random), coordinate(random)}).id, kUnknownPixel);
}

class RandomScores : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(SmoothOrNot, RandomScores, testing::Bool());

TEST_P(RandomScores, AgreeWithAPlainImplementation) {
  constexpr int kChannels = 5;
  const cv::Size grid(17, 11);
  const cv::Mat distances = randomDistances(kChannels, grid, GetParam(), 1);
  const GridPlacement placement{0.31, 0.27, -0.4, 0.2};
  const ScoreImage image(distances, {0, 1, 2, 3, 4}, {50, 40}, placement);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> across(-0.5, 49.5);
  std::uniform_real_distribution<double> down(-0.5, 39.5);
  std::vector<float> scores(kChannels);
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector2d pixel(across(random), down(random));
    const double x = std::clamp(0.31 * pixel.x() - 0.4, 0.0, grid.width - 1.0);
    const double y = std::clamp(0.27 * pixel.y() + 0.2, 0.0, grid.height - 1.0);
    std::array<double, kChannels> expected{};
    for (int channel = 0; channel < kChannels; ++channel) {
      double distance = 0;
      for (int row = 0; row < grid.height; ++row) {
        for (int column = 0; column < grid.width; ++column)
          distance += std::max(0.0, 1 - std::abs(x - column)) *
                      std::max(0.0, 1 - std::abs(y - row)) *
                      distances.at<std::uint8_t>(channel * grid.height + row, column);
      }
      expected[static_cast<std::size_t>(channel)] = std::exp(-distance / 16);
    }
    const double sum = std::accumulate(expected.begin(), expected.end(), 0.0);
    image.scoresAt(pixel, 1, scores);
    for (std::size_t channel = 0; channel < kChannels; ++channel)
      ASSERT_NEAR(scores[channel], expected[channel] / sum, 1e-4) << pixel.transpose();
  }
}

TEST_P(RandomScores, GiveTheSameWinnerByEveryWay) {
  constexpr int kChannels = 90;
  std::vector<ClassId> classes(kChannels);
  for (std::size_t i = 0; i < classes.size(); ++i)
    classes[i] = i % 10 == 9 ? kIgnoredPixel : static_cast<ClassId>(i % 10);
  const cv::Size size(64, 48);
  const GridPlacement placement{0.25, 0.25, -0.375, -0.375};
  const ScoreImage image(randomDistances(kChannels, {16, 12}, GetParam(), 3), classes, size,
                         placement);
  const cv::Mat map = image.classes();
  ASSERT_EQ(map.type(), CV_16UC1);
  ASSERT_EQ(map.size(), size);
  std::vector<float> scores(9);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const PixelClass best = image.classAt({u, v});
      ASSERT_EQ(map.at<ClassId>(v, u), best.id) << u << ' ' << v;
      const PixelClass same = image.scoresAt({u, v}, 1, scores);
      ASSERT_EQ(same.id, best.id) << u << ' ' << v;
      ASSERT_EQ(same.confidence, best.confidence) << u << ' ' << v;
      ASSERT_EQ(image.scoresAt({u, v}, 3, scores).id, best.id) << u << ' ' << v;
      const float sum = std::accumulate(scores.begin(), scores.end(), 0.0f);
      ASSERT_NEAR(sum, best.id == kIgnoredPixel ? 0 : 1, 1e-5) << u << ' ' << v;
    }
  }
}

TEST(ScoreImage, RefusesSizesThatDoNotFit) {
  const cv::Mat distances = cv::Mat::zeros(4, 3, CV_8UC1);
  EXPECT_NO_THROW(ScoreImage(distances, {0, 1}, {3, 2}, {}));
  EXPECT_THROW(ScoreImage(distances, {0, 1, 2}, {3, 2}, {}), std::invalid_argument);
  EXPECT_THROW(ScoreImage(distances, {}, {3, 2}, {}), std::invalid_argument);
  EXPECT_THROW(ScoreImage(distances, {0, 1}, {0, 2}, {}), std::invalid_argument);
  EXPECT_THROW(ScoreImage(cv::Mat(), {0, 1}, {3, 2}, {}), std::invalid_argument);
  EXPECT_THROW(ScoreImage(cv::Mat::zeros(4, 3, CV_16UC1), {0, 1}, {3, 2}, {}),
               std::invalid_argument);
}

}  // namespace
}  // namespace csom::test
