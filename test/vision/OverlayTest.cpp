// SPDX-License-Identifier: BSD-3-Clause
// Pictures for the report: the right colours at the right places.
#include <csom/vision/Overlay.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

namespace csom {
namespace {

const ClassColors kColors{{255, 255, 255}, {200, 0, 0}, {0, 0, 200}};

/// Classes as given, pixel by pixel.
class GivenClasses : public SemanticImage {
 public:
  explicit GivenClasses(cv::Mat classes) : classes_(std::move(classes)) {}
  cv::Size size() const override { return classes_.size(); }
  PixelClass classAt(const Eigen::Vector2d&) const override { return {}; }
  PixelClass scoresAt(const Eigen::Vector2d&, double, std::vector<float>&) const override {
    return {};
  }
  cv::Mat classes() const override { return classes_; }

 private:
  cv::Mat classes_;
};

cv::Mat grayImage(int width, int height) {
  return {height, width, CV_8UC3, cv::Scalar::all(100)};
}

/// A camera 64 × 48 pixels large that looks along z, and points one metre from it have pixel
/// coordinates of 32 times their own.
struct Camera {
  explicit Camera(int width = 64, int height = 48) : projection(calibrationOf(width, height)) {
    view.projection = &projection;
  }
  static CameraCalibration calibrationOf(int width, int height) {
    CameraCalibration calibration;
    calibration.width = width;
    calibration.height = height;
    calibration.fx = calibration.fy = 32;
    calibration.cx = width / 2;
    calibration.cy = height / 2;
    return calibration;
  }

  CameraProjection projection;
  CameraView view;
};

LabelledPoints labelled(std::vector<ClassId> classes) {
  LabelledPoints points;
  points.fates.assign(classes.size(), PointFate::Labelled);
  points.views.assign(classes.size(), 0);
  points.classes = std::move(classes);
  return points;
}

/// How many channels of pixels of a part of the picture the points changed.
int changedByDots(const Camera& camera, const std::vector<Eigen::Vector3f>& points,
                  const LabelledPoints& labels, const cv::Rect& part) {
  const CameraCalibration& calibration = camera.projection.calibration();
  const cv::Mat image = grayImage(calibration.width, calibration.height);
  cv::Mat changed;
  cv::absdiff(drawLabelledPoints(image, camera.view, 0, points, labels, kColors),
              drawLabelledPoints(image, camera.view, 0, {}, {}, kColors), changed);
  return cv::countNonZero(cv::Mat(changed, part).clone().reshape(1));
}

TEST(DrawSegmentationTest, TintsEachPixelHalfInTheColourOfItsClass) {
  const GivenClasses labels((cv::Mat_<ClassId>(1, 4) << 1, 2, kIgnoredPixel, kUnknownPixel));
  const cv::Mat picture = drawSegmentation(grayImage(4, 1), labels, kColors);
  ASSERT_EQ(picture.type(), CV_8UC3);
  EXPECT_EQ(picture.at<cv::Vec3b>(0, 0), cv::Vec3b(50, 50, 150));  // blue, green, red
  EXPECT_EQ(picture.at<cv::Vec3b>(0, 1), cv::Vec3b(150, 50, 50));
  EXPECT_EQ(picture.at<cv::Vec3b>(0, 2), cv::Vec3b(100, 100, 100));
  EXPECT_EQ(picture.at<cv::Vec3b>(0, 3), cv::Vec3b(100, 100, 100));
}

TEST(DrawSegmentationTest, TakesGrayImagesAndLeavesThemAsTheyAre) {
  const cv::Mat gray(2, 2, CV_8UC1, cv::Scalar(100));
  const GivenClasses labels(cv::Mat(2, 2, CV_16UC1, cv::Scalar(1)));
  EXPECT_EQ(drawSegmentation(gray, labels, kColors).at<cv::Vec3b>(1, 1), cv::Vec3b(50, 50, 150));
  const cv::Mat color = grayImage(2, 2);
  drawSegmentation(color, labels, kColors);
  EXPECT_EQ(color.at<cv::Vec3b>(1, 1), cv::Vec3b(100, 100, 100));
}

TEST(DrawSegmentationTest, AClassWithoutAColourIsNotTinted) {
  const GivenClasses labels((cv::Mat_<ClassId>(1, 1) << 3));
  EXPECT_EQ(drawSegmentation(grayImage(1, 1), labels, kColors).at<cv::Vec3b>(0, 0),
            cv::Vec3b(100, 100, 100));
}

TEST(DrawSegmentationTest, RefusesOtherSizesAndTypes) {
  const GivenClasses labels(cv::Mat(2, 2, CV_16UC1, cv::Scalar(1)));
  EXPECT_THROW(drawSegmentation(grayImage(3, 2), labels, kColors), std::invalid_argument);
  EXPECT_THROW(drawSegmentation(cv::Mat(2, 2, CV_16UC1), labels, kColors), std::invalid_argument);
}

TEST(DrawLabelledPointsTest, DrawsLabelledPointsInTheirColourOverTheDarkenedImage) {
  const Camera camera(640, 480);
  const cv::Mat picture = drawLabelledPoints(grayImage(640, 480), camera.view, 0,
                                             {{0, 0, 1}, {2, 0, 1}}, labelled({1, 2}), kColors);
  ASSERT_EQ(picture.size(), cv::Size(640, 480));
  EXPECT_EQ(picture.at<cv::Vec3b>(240, 320), cv::Vec3b(0, 0, 200));
  EXPECT_EQ(picture.at<cv::Vec3b>(240, 384), cv::Vec3b(200, 0, 0));
  EXPECT_LT(picture.at<cv::Vec3b>(0, 0)[0], 90);
  EXPECT_GT(picture.at<cv::Vec3b>(0, 0)[0], 0);
}

TEST(DrawLabelledPointsTest, PointsThatLostTheirLabelAreGray) {
  const Camera camera(640, 480);
  for (const PointFate fate : {PointFate::Hidden, PointFate::AtEdge, PointFate::LowConfidence,
                               PointFate::Ignored, PointFate::Unknown}) {
    LabelledPoints points = labelled({1});
    points.fates = {fate};
    const cv::Mat picture =
        drawLabelledPoints(grayImage(640, 480), camera.view, 0, {{0, 0, 1}}, points, kColors);
    const auto pixel = picture.at<cv::Vec3b>(240, 320);
    EXPECT_EQ(pixel, cv::Vec3b::all(pixel[0])) << static_cast<int>(fate);
    EXPECT_NE(pixel, picture.at<cv::Vec3b>(0, 0)) << static_cast<int>(fate);
    // Smaller, too: some class may be gray.
    const cv::Rect all(0, 0, 640, 480);
    EXPECT_LT(changedByDots(camera, {{0, 0, 1}}, points, all),
              changedByDots(camera, {{0, 0, 1}}, labelled({1}), all));
  }
}

TEST(DrawLabelledPointsTest, LeavesOutPointsOfOtherViewsAndPointsInNone) {
  const Camera camera(640, 480);
  LabelledPoints points = labelled({1, 2, 2, 2});
  points.views = {1, -1, 0, 0};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(changedByDots(camera, {{0, 0, 1}, {1, 0, 1}, {nan, 0, 1}, {0, 0, -1}}, points,
                          {0, 0, 640, 480}),
            0);
}

TEST(DrawLabelledPointsTest, NearPointsCoverFarOnesWhateverTheirOrder) {
  const Camera camera(640, 480);
  const auto pixel_of = [&](const std::vector<Eigen::Vector3f>& points,
                            const LabelledPoints& labels) {
    return drawLabelledPoints(grayImage(640, 480), camera.view, 0, points, labels, kColors)
        .at<cv::Vec3b>(240, 320);
  };
  EXPECT_EQ(pixel_of({{0, 0, 1}, {0, 0, 9}}, labelled({1, 2})), cv::Vec3b(0, 0, 200));
  EXPECT_EQ(pixel_of({{0, 0, 9}, {0, 0, 1}}, labelled({2, 1})), cv::Vec3b(0, 0, 200));
}

TEST(DrawLabelledPointsTest, PlacesPointsThroughThePoseOfTheCamera) {
  Camera camera(640, 480);
  camera.view.camera_from_points.translation() = Eigen::Vector3d(2, 0, 1);
  const cv::Mat picture = drawLabelledPoints(cv::Mat::zeros(480, 640, CV_8UC3), camera.view, 0,
                                             {{0, 0, 0}}, labelled({1}), kColors);
  EXPECT_EQ(picture.at<cv::Vec3b>(240, 320 + 64), cv::Vec3b(0, 0, 200));
}

TEST(DrawLabelledPointsTest, EnlargesSmallImagesWithTheirPoints) {
  const Camera camera(64, 48);
  const cv::Mat picture = drawLabelledPoints(cv::Mat::zeros(48, 64, CV_8UC3), camera.view, 0,
                                             {{0, 0, 1}}, labelled({1}), kColors);
  ASSERT_EQ(picture.size(), cv::Size(640, 480));
  // The centre of pixel (32, 24), ten times as large.
  EXPECT_EQ(picture.at<cv::Vec3b>(244, 324), cv::Vec3b(0, 0, 200));
  EXPECT_EQ(picture.at<cv::Vec3b>(244, 344), picture.at<cv::Vec3b>(0, 0));
}

TEST(DrawLabelledPointsTest, DotsAreSmallerWhereThereAreMore) {
  const Camera camera(640, 480);
  const auto area_of_one = [&](std::size_t others) {
    std::vector<Eigen::Vector3f> points{{0, 0, 1}};
    points.resize(1 + others, {9, 7, 1});  // all in a corner
    return changedByDots(camera, points, labelled(std::vector<ClassId>(points.size(), 1)),
                         {300, 220, 40, 40});
  };
  EXPECT_GT(area_of_one(0), 2 * area_of_one(50'000));
  EXPECT_GT(area_of_one(50'000), 0);
}

TEST(DrawLabelledPointsTest, RefusesWhatDoesNotBelongTogether) {
  const Camera camera(64, 48);
  EXPECT_THROW(
      drawLabelledPoints(grayImage(65, 48), camera.view, 0, {{0, 0, 1}}, labelled({1}), kColors),
      std::invalid_argument);
  EXPECT_THROW(
      drawLabelledPoints(grayImage(64, 48), camera.view, 0, {{0, 0, 1}}, labelled({1, 1}), kColors),
      std::invalid_argument);
}

TEST(ClassesShownTest, AreThoseOfSomePixel) {
  const GivenClasses labels((cv::Mat_<ClassId>(1, 5) << 7, 2, kIgnoredPixel, kUnknownPixel, 2));
  EXPECT_THAT(classesShown(labels), testing::ElementsAre(2, 7));
}

TEST(EncodeJpegTest, IsAJpegFileOfThePicture) {
  const std::vector<std::uint8_t> bytes = encodeJpeg(grayImage(64, 48));
  ASSERT_GT(bytes.size(), 3u);
  EXPECT_EQ(bytes[0], 0xff);
  EXPECT_EQ(bytes[1], 0xd8);
  const cv::Mat read = cv::imdecode(bytes, cv::IMREAD_COLOR);
  ASSERT_EQ(read.size(), cv::Size(64, 48));
  EXPECT_NEAR(read.at<cv::Vec3b>(24, 32)[1], 100, 2);
}

}  // namespace
}  // namespace csom
