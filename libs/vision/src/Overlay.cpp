// SPDX-License-Identifier: BSD-3-Clause
// Tinting images and drawing points over them.
#include <csom/vision/Overlay.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <stdexcept>

namespace csom {

namespace {

constexpr int kMinWidth = 640;
/// The image under the points has little contrast and no black, for bright and dark class colours
/// to stand out alike.
constexpr double kContrast = 0.35;
constexpr double kDarkest = 40;
constexpr std::array<std::uint8_t, 3> kWithoutLabel{150, 150, 150};
/// Of dots without a label, which gray alone would not tell from a gray class.
constexpr double kSmaller = 0.6;
/// cv::circle takes coordinates in units of 2^-kShift pixels.
constexpr int kShift = 4;

cv::Mat toBgr(const cv::Mat& image) {
  if (image.type() == CV_8UC3) return image.clone();
  if (image.type() != CV_8UC1)
    throw std::invalid_argument("a picture needs an image of 8 bits with 1 or 3 channels");
  cv::Mat bgr;
  cv::cvtColor(image, bgr, cv::COLOR_GRAY2BGR);
  return bgr;
}

void requireSize(const cv::Mat& image, cv::Size size) {
  if (image.size() != size)
    throw std::invalid_argument("the image and what is drawn over it differ in size");
}

struct Dot {
  Eigen::Vector2d pixel;
  double distance;  ///< from the camera
  bool has_label;
  std::array<std::uint8_t, 3> color;
};

std::vector<Dot> dotsOf(const CameraView& view, int view_number,
                        const std::vector<Eigen::Vector3f>& points, const LabelledPoints& labelled,
                        const ClassColors& colors) {
  std::vector<Dot> dots;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (labelled.views[i] != view_number) continue;
    const Eigen::Vector3d point = view.camera_from_points * points[i].cast<double>();
    const auto pixel = view.projection->project(point);
    if (!pixel || !view.projection->contains(*pixel)) continue;
    const ClassId k = labelled.classes[i];
    const bool has_label = labelled.fates[i] == PointFate::Labelled && k < colors.size();
    dots.push_back({*pixel, point.norm(), has_label, has_label ? colors[k] : kWithoutLabel});
  }
  std::stable_sort(dots.begin(), dots.end(),
                   [](const Dot& a, const Dot& b) { return a.distance > b.distance; });
  return dots;
}

/// Dots that nearly touch where they are dense, for scans are dense along their rows only.
double radiusOf(cv::Size size, std::size_t dots) {
  const double area_of_dot = static_cast<double>(size.area()) / static_cast<double>(dots);
  return std::clamp(0.28 * std::sqrt(area_of_dot), 1.25, 4.0);
}

void draw(cv::Mat& picture, const Dot& dot, int scale, double radius) {
  const auto fixed = [](double value) {
    return static_cast<int>(std::lround(value * (1 << kShift)));
  };
  // Pixel centres are whole numbers before and after the enlargement.
  const Eigen::Vector2d center = (dot.pixel.array() + 0.5) * scale - 0.5;
  cv::circle(picture, {fixed(center.x()), fixed(center.y())},
             fixed(dot.has_label ? radius : kSmaller * radius),
             cv::Scalar(dot.color[2], dot.color[1], dot.color[0]), cv::FILLED, cv::LINE_AA, kShift);
}

}  // namespace

cv::Mat drawSegmentation(const cv::Mat& image, const SemanticImage& labels,
                         const ClassColors& colors) {
  requireSize(image, labels.size());
  cv::Mat picture = toBgr(image);
  const cv::Mat classes = labels.classes();
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const ClassId k = classes.at<ClassId>(y, x);
      if (k >= colors.size()) continue;
      auto& pixel = picture.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c)
        pixel[c] =
            static_cast<std::uint8_t>((pixel[c] + colors[k][2 - static_cast<unsigned>(c)] + 1) / 2);
    }
  }
  return picture;
}

cv::Mat drawLabelledPoints(const cv::Mat& image, const CameraView& view, int view_number,
                           const std::vector<Eigen::Vector3f>& points,
                           const LabelledPoints& labelled, const ClassColors& colors) {
  const CameraCalibration& calibration = view.projection->calibration();
  requireSize(image, {calibration.width, calibration.height});
  if (labelled.fates.size() != points.size() || labelled.views.size() != points.size() ||
      labelled.classes.size() != points.size())
    throw std::invalid_argument("labels and points differ in number");

  cv::Mat picture;
  toBgr(image).convertTo(picture, -1, kContrast, kDarkest);
  const int scale = std::max(1, (kMinWidth + image.cols - 1) / image.cols);
  cv::resize(picture, picture, {}, scale, scale, cv::INTER_LINEAR);
  const std::vector<Dot> dots = dotsOf(view, view_number, points, labelled, colors);
  const double radius = dots.empty() ? 0 : radiusOf(picture.size(), dots.size());
  for (const Dot& dot : dots) draw(picture, dot, scale, radius);
  return picture;
}

std::vector<ClassId> classesShown(const SemanticImage& labels) {
  const cv::Mat classes = labels.classes();
  std::set<ClassId> shown(classes.begin<ClassId>(), classes.end<ClassId>());
  shown.erase(kIgnoredPixel);
  shown.erase(kUnknownPixel);
  return {shown.begin(), shown.end()};
}

std::vector<std::uint8_t> encodeJpeg(const cv::Mat& picture) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, 88});
  return bytes;
}

}  // namespace csom
