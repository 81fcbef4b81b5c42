// SPDX-License-Identifier: BSD-3-Clause
// labelPoints: which view decides, what it makes of it, and what becomes of the other points.
#include <csom/core/Options.h>
#include <csom/vision/PointLabelling.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace csom {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using testing::ElementsAre;
using testing::FloatEq;
using testing::FloatNear;
using testing::HasSubstr;
using LabelMode = PointLabellingOptions::LabelMode;
using LowConfidence = PointLabellingOptions::LowConfidence;
using SeveralCameras = PointLabellingOptions::SeveralCameras;

constexpr int kClasses = 4;
constexpr int kSize = 100;

/// The same distribution everywhere, or no class.
class UniformImage : public SemanticImage {
 public:
  explicit UniformImage(std::vector<float> scores, int size = kSize)
      : scores_(std::move(scores)), size_(size) {
    best_.id = 0;
    for (std::size_t k = 1; k < scores_.size(); ++k) {
      if (scores_[k] > scores_[best_.id]) best_.id = static_cast<ClassId>(k);
    }
    best_.confidence = scores_[best_.id];
  }
  explicit UniformImage(ClassId no_class)
      : scores_(kClasses, 0.0F), size_(kSize), best_{no_class, 0} {}

  cv::Size size() const override { return {size_, size_}; }
  PixelClass classAt(const Vector2d&) const override { return best_; }
  PixelClass scoresAt(const Vector2d&, double, std::vector<float>& scores) const override {
    scores = scores_;
    return best_;
  }
  cv::Mat classes() const override { return {size(), CV_16UC1, cv::Scalar(best_.id)}; }

 private:
  std::vector<float> scores_;
  int size_;
  PixelClass best_;
};

/// All of one class.
UniformImage certain(ClassId id) {
  std::vector<float> scores(kClasses, 0.0F);
  scores[id] = 1;
  return UniformImage(scores);
}

CameraCalibration calibration() {
  return {kSize, kSize, 50, 50, 49.5, 49.5, LensDistortion::None, {}};
}

class PointLabellingTest : public testing::Test {
 protected:
  /// Looks along z, turned to the right by `turn` [rad].
  CameraView view(const SemanticImage& image, double turn = 0) const {
    CameraView view{&projection_, Eigen::Isometry3d::Identity(), &image};
    view.camera_from_points.rotate(Eigen::AngleAxisd(-turn, Vector3d::UnitY()));
    return view;
  }
  LabelledPoints label(const std::vector<Vector3f>& points,
                       const std::vector<CameraView>& views) const {
    return labelPoints(points, views, kClasses, options_);
  }

  CameraProjection projection_{calibration()};
  PointLabellingOptions options_;
};

const Vector3f kAhead(0, 0, 5);
const Vector3f kBehind(0, 0, -5);
/// In the image, far from its centre.
const Vector3f kRight(4, 0, 5);

TEST_F(PointLabellingTest, PointsTakeTheLabelOfTheirPixel) {
  cv::Mat raw(kSize, kSize, CV_8UC1, cv::Scalar(1));
  raw.colRange(50, 100).setTo(3);
  const LabelImage image(raw, [](std::uint32_t id) { return static_cast<ClassId>(id); });
  const auto labelled = label({{-2, 0, 5}, kAhead, {2, 0, 5}}, {view(image)});
  EXPECT_EQ(labelled.fates[0], PointFate::Labelled);
  EXPECT_EQ(labelled.classes[0], 1);
  EXPECT_EQ(labelled.classes[2], 3);
  // Exactly between two pixels.
  EXPECT_EQ(labelled.fates[1], PointFate::AtEdge);
  EXPECT_TRUE(labelled.scores.empty());
  EXPECT_THAT(labelled.views, ElementsAre(0, 0, 0));
}

TEST_F(PointLabellingTest, PointsOfAnyFrame) {
  const UniformImage image = certain(2);
  CameraView moved = view(image);
  moved.camera_from_points.pretranslate(Vector3d(0, 0, 10));
  EXPECT_EQ(label({kBehind}, {moved}).fates[0], PointFate::Labelled);
  EXPECT_EQ(label({kBehind}, {view(image)}).fates[0], PointFate::OutsideView);
}

TEST_F(PointLabellingTest, PointsOutsideOfAllViews) {
  const UniformImage image = certain(2);
  const float nan = std::nanf("");
  const auto labelled = label({kBehind, {50, 0, 5}, {nan, 0, 5}, {0, 0, nan}}, {view(image)});
  for (const PointFate fate : labelled.fates) EXPECT_EQ(fate, PointFate::OutsideView);
  EXPECT_THAT(labelled.views, ElementsAre(-1, -1, -1, -1));
  EXPECT_EQ(label({kAhead}, {}).fates[0], PointFate::OutsideView);
  EXPECT_TRUE(label({}, {view(image)}).fates.empty());
}

TEST_F(PointLabellingTest, PixelsWithoutAClass) {
  for (const auto& [id, fate] :
       {std::pair{kIgnoredPixel, PointFate::Ignored}, {kUnknownPixel, PointFate::Unknown}}) {
    const UniformImage image(id);
    const auto labelled = label({kAhead}, {view(image)});
    EXPECT_EQ(labelled.fates[0], fate);
    EXPECT_EQ(labelled.views[0], 0);
  }
  const UniformImage sky = certain(kFreeClass);
  EXPECT_EQ(label({kAhead}, {view(sky)}).fates[0], PointFate::Ignored) << "a point is not free";
}

TEST_F(PointLabellingTest, TheViewNearestToItsCentreDecides) {
  const UniformImage ahead = certain(1);
  const UniformImage right = certain(2);
  for (const bool swapped : {false, true}) {
    std::vector<CameraView> views{view(ahead), view(right, 0.6)};
    if (swapped) std::swap(views[0], views[1]);
    const auto labelled = label({kAhead, kRight}, views);
    EXPECT_THAT(labelled.classes, ElementsAre(1, 2));
    EXPECT_EQ(labelled.views[0], swapped ? 1 : 0);
    EXPECT_EQ(labelled.views[1], swapped ? 0 : 1);
  }
}

TEST_F(PointLabellingTest, TheNextViewDecidesIfTheBestCannot) {
  const UniformImage ignored(kIgnoredPixel);
  const UniformImage unknown(kUnknownPixel);
  const UniformImage right = certain(2);
  auto labelled = label({kAhead}, {view(ignored), view(right, 0.6)});
  EXPECT_EQ(labelled.fates[0], PointFate::Labelled);
  EXPECT_EQ(labelled.classes[0], 2);
  EXPECT_EQ(labelled.views[0], 1);

  labelled = label({kAhead}, {view(unknown, 0.6), view(ignored)});
  EXPECT_EQ(labelled.fates[0], PointFate::Ignored) << "that of the best view";
  EXPECT_EQ(labelled.views[0], 1);

  const UniformImage doubtful({0, 0.6F, 0.4F, 0});
  options_.min_confidence = 0.8;
  labelled = label({kAhead}, {view(doubtful), view(right, 0.6)});
  EXPECT_EQ(labelled.fates[0], PointFate::Labelled);
  EXPECT_EQ(labelled.classes[0], 2);
}

TEST_F(PointLabellingTest, AllViewsVote) {
  options_.several_cameras = SeveralCameras::Vote;
  options_.label_mode = LabelMode::Soft;
  const UniformImage a({0, 0.6F, 0.4F, 0});
  const UniformImage b({0, 0.1F, 0.5F, 0.4F});
  const UniformImage ignored(kIgnoredPixel);
  const auto labelled = label({kAhead, kBehind}, {view(a), view(b, 0.2), view(ignored, 0.1)});
  EXPECT_EQ(labelled.fates[0], PointFate::Labelled);
  EXPECT_EQ(labelled.classes[0], 2);
  EXPECT_EQ(labelled.views[0], 0) << "the best of those that say something";
  EXPECT_THAT(labelled.scores,
              ElementsAre(FloatEq(0), FloatNear(0.35F, 1e-6F), FloatNear(0.45F, 1e-6F),
                          FloatNear(0.2F, 1e-6F), 0, 0, 0, 0));
  options_.min_confidence = 0.5;
  EXPECT_EQ(label({kAhead}, {view(a), view(b, 0.2)}).fates[0], PointFate::LowConfidence);
}

TEST_F(PointLabellingTest, SoftLabelsAreDistributions) {
  const UniformImage image({0, 0.7F, 0.2F, 0.1F});
  EXPECT_TRUE(label({kAhead}, {view(image)}).scores.empty()) << "hard";
  options_.label_mode = LabelMode::Soft;
  const auto labelled = label({kBehind, kAhead}, {view(image)});
  EXPECT_THAT(labelled.scores, ElementsAre(0, 0, 0, 0, 0, 0.7F, 0.2F, 0.1F));
  EXPECT_EQ(labelled.classes[1], 1);
  const UniformImage sure = certain(3);
  EXPECT_TRUE(label({kAhead}, {view(sure)}).scores.empty()) << "all are sure";
}

TEST_F(PointLabellingTest, PointsThatAreNotSure) {
  const UniformImage sure = certain(3);
  const UniformImage doubtful({0, 0.6F, 0.4F, 0});
  const std::vector<CameraView> views{view(doubtful), view(sure, 1.5)};
  const Vector3f right(5, 0, 0.5F);
  options_.min_confidence = 0.6001;
  auto labelled = label({kAhead, right}, views);
  EXPECT_THAT(labelled.fates, ElementsAre(PointFate::LowConfidence, PointFate::Labelled));
  EXPECT_TRUE(labelled.scores.empty());

  options_.low_confidence = LowConfidence::Soft;
  labelled = label({kAhead, right}, views);
  EXPECT_THAT(labelled.fates, ElementsAre(PointFate::Labelled, PointFate::Labelled));
  EXPECT_THAT(labelled.scores, ElementsAre(0, 0.6F, 0.4F, 0, 0, 0, 0, 1));

  options_.min_confidence = 0.5999;
  labelled = label({kAhead, right}, views);
  EXPECT_THAT(labelled.classes, ElementsAre(1, 3));
  EXPECT_TRUE(labelled.scores.empty());
}

/// A screen 3 m away, and a point 10 m away behind its middle.
std::vector<Vector3f> screenAndPoint() {
  std::vector<Vector3f> points;
  for (float x = -0.5F; x <= 0.5F; x += 0.1F) {
    for (float y = -0.5F; y <= 0.5F; y += 0.1F) points.emplace_back(x, y, 3.0F);
  }
  points.emplace_back(0.1F, 0.1F, 10.0F);
  return points;
}

TEST_F(PointLabellingTest, HiddenPointsTakeTheLabelOfTheNextView) {
  const UniformImage front = certain(1);
  auto labelled = label(screenAndPoint(), {view(front)});
  EXPECT_EQ(labelled.fates.back(), PointFate::Hidden);
  EXPECT_EQ(labelled.fates.front(), PointFate::Labelled);

  const UniformImage above = certain(2);
  CameraView from_above = view(above);
  from_above.camera_from_points.pretranslate(Vector3d(0, 4, 0));
  labelled = label(screenAndPoint(), {view(front), from_above});
  EXPECT_EQ(labelled.fates.back(), PointFate::Labelled);
  EXPECT_EQ(labelled.classes.back(), 2);
  EXPECT_EQ(labelled.views.back(), 1);

  options_.visibility = false;
  options_.edge_margin = 0;
  labelled = label(screenAndPoint(), {view(front)});
  EXPECT_EQ(labelled.fates.back(), PointFate::Labelled);
}

TEST_F(PointLabellingTest, CountsEveryPointOnce) {
  const UniformImage front = certain(1);
  std::vector<Vector3f> points = screenAndPoint();
  points.push_back(kBehind);
  const FateCounts counts = label(points, {view(front)}).counts();
  EXPECT_EQ(counts[static_cast<std::size_t>(PointFate::Hidden)], 1u);
  EXPECT_EQ(counts[static_cast<std::size_t>(PointFate::OutsideView)], 1u);
  EXPECT_EQ(counts[static_cast<std::size_t>(PointFate::Labelled)], points.size() - 2);
}

TEST_F(PointLabellingTest, ViewsMustFit) {
  const UniformImage image = certain(1);
  const UniformImage small({0, 1, 0, 0}, kSize / 2);
  EXPECT_THROW(label({kAhead}, {view(small)}), std::invalid_argument);
  CameraView incomplete = view(image);
  incomplete.projection = nullptr;
  EXPECT_THROW(label({kAhead}, {incomplete}), std::invalid_argument);
  incomplete = view(image);
  incomplete.image = nullptr;
  EXPECT_THROW(label({kAhead}, {incomplete}), std::invalid_argument);
  EXPECT_THROW(labelPoints({kAhead}, {view(image)}, 0, options_), std::invalid_argument);
}

std::string errorOf(const PointLabellingOptions& options) {
  try {
    labelPoints({}, {}, kClasses, options);
  } catch (const OptionError& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(PointLabellingTest, OptionsNameTheKeyAndTheValue) {
  EXPECT_EQ(errorOf({}), "no error");
  PointLabellingOptions bad;
  bad.temperature = 0;
  EXPECT_THAT(errorOf(bad), HasSubstr("temperature = 0"));
  bad = {};
  bad.min_confidence = 1.5;
  EXPECT_THAT(errorOf(bad), HasSubstr("min_confidence = 1.5"));
  bad = {};
  bad.visibility_margin = -0.1;
  EXPECT_THAT(errorOf(bad), HasSubstr("visibility_margin = -0.1"));
  bad.visibility_margin = std::numeric_limits<double>::infinity();
  EXPECT_THAT(errorOf(bad), HasSubstr("visibility_margin = inf"));
  bad = {};
  bad.edge_margin = -1;
  EXPECT_THAT(errorOf(bad), HasSubstr("edge_margin = -1"));
  bad.edge_margin = std::nan("");
  EXPECT_THAT(errorOf(bad), HasSubstr("edge_margin = nan"));
}

TEST(PointFate, HasADistinctNameEach) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kPointFates; ++i)
    names.emplace_back(toString(static_cast<PointFate>(i)));
  EXPECT_THAT(names, ElementsAre("labelled", "outside_view", "hidden", "at_edge", "low_confidence",
                                 "ignored", "unknown"));
}

}  // namespace
}  // namespace csom
