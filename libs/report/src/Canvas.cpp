// SPDX-License-Identifier: BSD-3-Clause
// OpenCV's drawing primitives at twice the size.
#include "Canvas.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace csom {

namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kFontSize = 0.5;
constexpr int kStroke = 2;  // of the enlarged picture

cv::Scalar toBgr(const Color& c) {
  return {double(c[2]), double(c[1]), double(c[0])};
}

}  // namespace

Canvas::Canvas(int width, int height)
    : image_(height * kScale, width * kScale, CV_8UC3, cv::Scalar::all(255)) {}

void Canvas::image(const cv::Mat& picture, cv::Point corner) {
  picture.copyTo(image_(cv::Rect(corner * kScale, picture.size())));
}

void Canvas::rectangle(const cv::Rect& area, const Color& color) {
  image_(cv::Rect(area.tl() * kScale, area.size() * kScale)).setTo(toBgr(color));
}

void Canvas::frame(const cv::Rect& area, const Color& color) {
  cv::rectangle(image_, cv::Rect(area.tl() * kScale, area.size() * kScale), toBgr(color), kStroke);
}

void Canvas::line(cv::Point from, cv::Point to, const Color& color) {
  cv::line(image_, from * kScale, to * kScale, toBgr(color), kStroke * 2, cv::LINE_AA);
}

void Canvas::arrow(cv::Point from, cv::Point to, const Color& color) {
  cv::arrowedLine(image_, from * kScale, to * kScale, toBgr(color), kStroke * 2, cv::LINE_AA, 0,
                  0.25);
}

void Canvas::text(const std::string& text, cv::Point baseline, const Color& color) {
  cv::putText(image_, text, baseline * kScale, kFont, kFontSize * kScale, toBgr(color), kStroke,
              cv::LINE_AA);
}

int Canvas::textWidth(const std::string& text) {
  int below_baseline = 0;
  return cv::getTextSize(text, kFont, kFontSize * kScale, kStroke, &below_baseline).width / kScale;
}

std::vector<std::uint8_t> Canvas::toPng() const {
  cv::Mat reduced;
  cv::resize(image_, reduced, image_.size() / kScale, 0, 0, cv::INTER_AREA);
  std::vector<std::uint8_t> bytes;
  // By default OpenCV is in a hurry: the page carries four of these.
  if (!cv::imencode(".png", reduced, bytes,
                    {cv::IMWRITE_PNG_COMPRESSION, 9, cv::IMWRITE_PNG_STRATEGY,
                     cv::IMWRITE_PNG_STRATEGY_DEFAULT}))
    throw std::runtime_error("OpenCV cannot encode PNG");
  return bytes;
}

}  // namespace csom
