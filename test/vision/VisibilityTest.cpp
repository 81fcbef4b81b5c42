// SPDX-License-Identifier: BSD-3-Clause
// Hidden points and points at edges, in small scenes whose truth is known.
#include <csom/vision/Visibility.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace csom {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3d;

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr std::uint16_t kBackground = 1;
constexpr std::uint16_t kObject = 2;

/// An upright rectangle across the x axis, or the ground.
struct Surface {
  double x;
  double y_min, y_max;
  double z_min, z_max;
  std::uint16_t label;
};

/// A camera looks along x from the origin (pinhole, focal length 300 pixels); a LiDAR of 16 rings
/// stands somewhere else.
class Scene {
 public:
  explicit Scene(const Vector3d& lidar) : lidar_(lidar) {}

  static constexpr int kWidth = 640;
  static constexpr int kHeight = 480;
  static constexpr double kFocal = 300;
  static constexpr double kGround = -1.5;

  void add(const Surface& surface) { surfaces_.push_back(surface); }

  struct Hit {
    double distance = std::numeric_limits<double>::infinity();
    std::uint16_t label = 0;
  };

  /// The ground has the label of the background.
  Hit cast(const Vector3d& from, const Vector3d& ray) const {
    Hit nearest;
    if (ray.z() < 0) nearest = {(kGround - from.z()) / ray.z(), kBackground};
    for (const Surface& s : surfaces_) {
      const double t = (s.x - from.x()) / ray.x();
      const Vector3d at = from + t * ray;
      const bool inside =
          at.y() >= s.y_min && at.y() <= s.y_max && at.z() >= s.z_min && at.z() <= s.z_max;
      if (t > 0 && inside && t < nearest.distance) nearest = {t, s.label};
    }
    return nearest;
  }

  struct Seen {
    std::vector<ProjectedPoint> points;
    std::vector<bool> visible;
    std::vector<std::uint16_t> labels;  ///< true ones
  };

  Seen scan() const {
    Seen seen;
    for (int ring = 0; ring < 16; ++ring) {
      for (double azimuth = -45; azimuth <= 45; azimuth += 0.2) {
        const double elevation = (-15 + 2 * ring) * kDegree;
        const Vector3d ray(std::cos(elevation) * std::cos(azimuth * kDegree),
                           std::cos(elevation) * std::sin(azimuth * kDegree), std::sin(elevation));
        const Hit hit = cast(lidar_, ray);
        if (hit.distance > 60) continue;
        const Vector3d point = lidar_ + hit.distance * ray;
        const Vector2f pixel(static_cast<float>(kWidth / 2.0 - kFocal * point.y() / point.x()),
                             static_cast<float>(kHeight / 2.0 - kFocal * point.z() / point.x()));
        if (point.x() <= 0 || pixel.minCoeff() < 0 || pixel.x() > kWidth - 1 ||
            pixel.y() > kHeight - 1)
          continue;
        seen.points.push_back({pixel, static_cast<float>(point.norm())});
        const double reached = cast(Vector3d::Zero(), point.normalized()).distance;
        seen.visible.push_back(reached > point.norm() - 0.05);
        seen.labels.push_back(hit.label);
      }
    }
    return seen;
  }

  cv::Mat labelImage() const {
    cv::Mat image(kHeight, kWidth, CV_16UC1);
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 0; u < kWidth; ++u)
        image.at<std::uint16_t>(v, u) =
            cast(Vector3d::Zero(),
                 Vector3d(kFocal, kWidth / 2.0 - u, kHeight / 2.0 - v).normalized())
                .label;
    }
    return image;
  }

 private:
  Vector3d lidar_;
  std::vector<Surface> surfaces_;
};

double share(std::size_t part, std::size_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

std::uint16_t labelAt(const cv::Mat& image, const Vector2f& pixel) {
  return image.at<std::uint16_t>(static_cast<int>(std::floor(pixel.y() + 0.5F)),
                                 static_cast<int>(std::floor(pixel.x() + 0.5F)));
}

const cv::Size kImage(Scene::kWidth, Scene::kHeight);
const Surface kWall{20, -40, 40, Scene::kGround, 10, kBackground};
const Surface kBox{5, -1, 1, Scene::kGround, 0.4, kObject};

TEST(HiddenPoints, AnObjectHidesWhatTheLidarSeesPastIt) {
  for (const Vector3d& lidar : {Vector3d(0, 0, 0.8), Vector3d(0, 0.8, 0), Vector3d(0, -0.5, 0.3)}) {
    Scene scene(lidar);
    scene.add(kWall);
    scene.add(kBox);
    const Scene::Seen seen = scene.scan();
    const auto hidden = hiddenPoints(seen.points, kImage, 0.5);
    std::size_t truly_hidden = 0;
    std::size_t found = 0;
    for (std::size_t i = 0; i < seen.points.size(); ++i) {
      if (seen.visible[i]) {
        EXPECT_FALSE(hidden[i]) << seen.points[i].pixel.transpose();
        continue;
      }
      ++truly_hidden;
      if (hidden[i]) ++found;
    }
    ASSERT_GT(truly_hidden, 40u) << "lidar at " << lidar.transpose();
    // Not the strip above the topmost ring on the box.
    EXPECT_GT(share(found, truly_hidden), 0.45) << "lidar at " << lidar.transpose();
  }
}

TEST(HiddenPoints, NothingIsHiddenForALidarInTheCamera) {
  Scene scene(Vector3d::Zero());
  scene.add(kWall);
  scene.add(kBox);
  const Scene::Seen seen = scene.scan();
  for (const bool hidden : hiddenPoints(seen.points, kImage, 0.1)) EXPECT_FALSE(hidden);
}

TEST(HiddenPoints, GroundAtGrazingAnglesDoesNotHideItself) {
  Scene scene(Vector3d(-0.3, 0.4, 0.5));
  const Scene::Seen seen = scene.scan();
  ASSERT_GT(seen.points.size(), 2000u);
  for (const double margin : {0.0, 0.2, 1.0}) {
    for (const bool hidden : hiddenPoints(seen.points, kImage, margin)) EXPECT_FALSE(hidden);
  }
}

TEST(HiddenPoints, WhatIsNearerByLessThanTheMarginDoesNotHide) {
  Scene scene(Vector3d(0, 0, 0.8));
  scene.add({6.5, -40, 40, Scene::kGround, 10, kBackground});
  scene.add(kBox);
  const Scene::Seen seen = scene.scan();
  const auto count = [&](double margin) {
    const auto hidden = hiddenPoints(seen.points, kImage, margin);
    return std::count(hidden.begin(), hidden.end(), true);
  };
  EXPECT_GT(count(1), 20);
  EXPECT_EQ(count(3), 0);
}

/// Two rings of a screen 3 m away, `gap` pixels apart, and one point 10 m away between them.
std::vector<ProjectedPoint> pointBetweenRings(float gap) {
  std::vector<ProjectedPoint> points;
  for (float u = 100; u <= 200; u += 2) {
    for (const float v : {100.0F, 100 + gap}) points.push_back({{u, v}, 3});
  }
  // Rings of something far below say how far rings are apart in this scan.
  for (float u = 100; u <= 400; u += 2) {
    for (float v = 250; v <= 350; v += 10) points.push_back({{u, v}, 3});
  }
  points.push_back({{151, 100 + gap / 2}, 10});
  return points;
}

TEST(HiddenPoints, TheSpacingOfTheScanSaysWhetherThereIsAGap) {
  EXPECT_TRUE(hiddenPoints(pointBetweenRings(10), {640, 480}, 0.5).back());
  EXPECT_FALSE(hiddenPoints(pointBetweenRings(40), {640, 480}, 0.5).back());
}

TEST(HiddenPoints, DifferentThingsAboveAndBelowLeaveAGap) {
  std::vector<ProjectedPoint> points = pointBetweenRings(10);
  for (ProjectedPoint& point : points) {
    if (point.pixel.y() == 100) point.depth = 9;
  }
  EXPECT_FALSE(hiddenPoints(points, {640, 480}, 0.5).back());
}

TEST(HiddenPoints, TakesAnyPoints) {
  EXPECT_TRUE(hiddenPoints({}, {640, 480}, 0.5).empty());
  EXPECT_EQ(hiddenPoints({{{10, 10}, 3}}, {640, 480}, 0.5), std::vector<bool>{false});
  // One place, and one row.
  EXPECT_EQ(hiddenPoints(std::vector<ProjectedPoint>(100000, {{10, 10}, 3}), {640, 480}, 0.5),
            std::vector<bool>(100000, false));
  std::vector<ProjectedPoint> row;
  for (float u = 0; u < 640; ++u) row.push_back({{u, 20}, u == 300 ? 10.0F : 3.0F});
  EXPECT_EQ(hiddenPoints(row, {640, 480}, 0.5), std::vector<bool>(row.size(), false));
}

TEST(HiddenPoints, DoesNotDependOnTheOrderOfPoints) {
  Scene scene(Vector3d(0, 0.8, 0.4));
  scene.add(kWall);
  scene.add(kBox);
  std::vector<ProjectedPoint> points = scene.scan().points;
  // Few enough that all of them are looked at for their spacing.
  points.resize(1000);
  const auto hidden = hiddenPoints(points, kImage, 0.5);
  ASSERT_EQ(points.size(), 1000u);
  std::vector<std::size_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937(4));
  std::vector<ProjectedPoint> shuffled;
  for (const std::size_t i : order) shuffled.push_back(points[i]);
  const auto hidden_shuffled = hiddenPoints(shuffled, kImage, 0.5);
  for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(hidden_shuffled[i], hidden[order[i]]);
}

// --- Points at edges -----------------------------------------------------------------------------

/// Of the points that the camera image would label wrongly, and of all others: how many are kept.
struct Kept {
  double of_wrong;
  double of_right;
};

Kept keptOf(const Scene::Seen& seen, const cv::Mat& image, double edge_margin) {
  const auto hidden = hiddenPoints(seen.points, kImage, 0.5);
  const auto at_edge = pointsAtEdges(seen.points, image, edge_margin, 0.5);
  std::size_t wrong = 0;
  std::size_t wrong_kept = 0;
  std::size_t right = 0;
  std::size_t right_kept = 0;
  for (std::size_t i = 0; i < seen.points.size(); ++i) {
    const bool kept = !hidden[i] && !at_edge[i];
    if (labelAt(image, seen.points[i].pixel) == seen.labels[i]) {
      ++right;
      if (kept) ++right_kept;
    } else {
      ++wrong;
      if (kept) ++wrong_kept;
    }
  }
  EXPECT_GT(wrong, 20u);
  return {share(wrong_kept, wrong), share(right_kept, right)};
}

TEST(PointsAtEdges, RejectsTheStripsAroundAnObject) {
  for (const Vector3d& lidar : {Vector3d(0, 0, 0.8), Vector3d(0, 0.8, 0), Vector3d(0, -0.5, 0.3)}) {
    Scene scene(lidar);
    scene.add(kWall);
    scene.add(kBox);
    const Kept kept = keptOf(scene.scan(), scene.labelImage(), 2);
    EXPECT_LT(kept.of_wrong, 0.08) << "lidar at " << lidar.transpose();
    EXPECT_GT(kept.of_right, 0.98) << "lidar at " << lidar.transpose();
  }
}

/// The labels of an object, drawn larger by some pixels.
cv::Mat bled(const cv::Mat& image, int pixels) {
  cv::Mat out = image.clone();
  for (int v = pixels; v < image.rows - pixels; ++v) {
    for (int u = pixels; u < image.cols - pixels; ++u) {
      for (int d = -pixels; d <= pixels; ++d) {
        if (image.at<std::uint16_t>(v, u + d) == kObject) out.at<std::uint16_t>(v, u) = kObject;
      }
    }
  }
  return out;
}

TEST(PointsAtEdges, TheEdgeMarginIsHowFarLabelsMayBleed) {
  Scene scene(Vector3d(0, 0, 0.2));
  scene.add(kWall);
  scene.add(kBox);
  const Scene::Seen seen = scene.scan();
  const cv::Mat image = bled(scene.labelImage(), 6);
  EXPECT_LT(keptOf(seen, image, 7).of_wrong, 0.1);
  EXPECT_GT(keptOf(seen, image, 1).of_wrong, 0.3);
}

TEST(PointsAtEdges, ABorderOnOneSurfaceIsKept) {
  // The wall has a door, and the ground a border: nothing jumps.
  Scene scene(Vector3d(0, 0.3, 0.3));
  scene.add(kWall);
  const Scene::Seen seen = scene.scan();
  cv::Mat image(kImage, CV_16UC1, cv::Scalar(kBackground));
  image(cv::Rect(300, 180, 60, 200)).setTo(kObject);
  const auto at_edge = pointsAtEdges(seen.points, image, 3, 0.5);
  for (std::size_t i = 0; i < seen.points.size(); ++i) {
    const Vector2f pixel = seen.points[i].pixel;
    const float to_border = std::min(std::abs(pixel.x() - 299.5F), std::abs(pixel.x() - 359.5F));
    const bool in_rows = pixel.y() > 180.5F && pixel.y() < 378.5F;
    if (in_rows && to_border > 0.1F) {
      EXPECT_FALSE(at_edge[i]) << pixel.transpose();
    } else if (in_rows && to_border < 0.08F) {
      EXPECT_TRUE(at_edge[i]) << pixel.transpose();
    }
  }
}

TEST(PointsAtEdges, TheStaircaseOfASlantedBorderIsALine) {
  // Class 2 above the line v = 100.3 + 0.24 (u − 200).
  const auto border = [](double u) { return 100.3 + 0.24 * (u - 200); };
  cv::Mat image(kImage, CV_16UC1, cv::Scalar(kBackground));
  for (int u = 0; u < image.cols; ++u) {
    for (int v = 0; v < image.rows && v < border(u); ++v) image.at<std::uint16_t>(v, u) = kObject;
  }
  std::vector<ProjectedPoint> points;
  std::vector<bool> wrong;
  std::mt19937 random(2);
  std::uniform_real_distribution<float> place(190, 400);
  std::uniform_real_distribution<float> beside(-1.5F, 1.5F);
  for (int i = 0; i < 2000; ++i) {
    const float u = place(random);
    const Vector2f pixel(u, static_cast<float>(border(u)) + beside(random));
    points.push_back({pixel, 10});
    wrong.push_back((labelAt(image, pixel) == kObject) != (pixel.y() < border(u)));
  }
  const auto at_edge = pointsAtEdges(points, image, 2, 0.5);
  std::size_t wrong_kept = 0;
  std::size_t right_lost = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (wrong[i] && !at_edge[i]) ++wrong_kept;
    if (!wrong[i] && at_edge[i]) ++right_lost;
  }
  const auto wrongs = static_cast<std::size_t>(std::count(wrong.begin(), wrong.end(), true));
  ASSERT_GT(wrongs, 100u);
  EXPECT_LT(share(wrong_kept, wrongs), 0.25);
  EXPECT_LT(share(right_lost, points.size() - wrongs), 0.12);
}

TEST(PointsAtEdges, TakesAnyPoints) {
  const cv::Mat image(kImage, CV_16UC1, cv::Scalar(kBackground));
  EXPECT_TRUE(pointsAtEdges({}, image, 2, 0.5).empty());
  const std::vector<ProjectedPoint> corners{{{-0.5F, -0.5F}, 3}, {{639.49F, 479.49F}, 3}};
  EXPECT_EQ(pointsAtEdges(corners, image, 2, 0.5), std::vector<bool>(2, false));
  EXPECT_EQ(pointsAtEdges(std::vector<ProjectedPoint>(100000, {{10, 10}, 3}), image, 2, 0.5),
            std::vector<bool>(100000, false));
}

}  // namespace
}  // namespace csom
