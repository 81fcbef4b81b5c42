// SPDX-License-Identifier: BSD-3-Clause
// Smooth lines and text for pictures, without a display or fonts.
#pragma once

#include <csom/io/LabelSet.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace csom {

/// A white picture that is drawn at twice its size and reduced at the end, which makes OpenCV's
/// stroke font legible. Coordinates and sizes are pixels of the final picture.
class Canvas {
 public:
  static constexpr int kScale = 2;

  Canvas(int width, int height);

  int width() const { return image_.cols / kScale; }
  int height() const { return image_.rows / kScale; }

  /// Copies a picture (8-bit BGR) that is kScale times as large with its upper left corner to
  /// `corner`.
  void image(const cv::Mat& picture, cv::Point corner);
  void rectangle(const cv::Rect& area, const Color& color);
  void frame(const cv::Rect& area, const Color& color);
  void line(cv::Point from, cv::Point to, const Color& color);
  void arrow(cv::Point from, cv::Point to, const Color& color);
  /// `baseline` is where the text starts. Characters that are not ASCII appear as '?'.
  void text(const std::string& text, cv::Point baseline, const Color& color);
  static int textWidth(const std::string& text);

  std::vector<std::uint8_t> toPng() const;

 private:
  cv::Mat image_;
};

}  // namespace csom
