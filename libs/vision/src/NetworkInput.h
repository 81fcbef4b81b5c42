// SPDX-License-Identifier: BSD-3-Clause
// How images lie in the input of a network.
#pragma once

#include <csom/vision/SegmentationNetwork.h>

#include <array>
#include <vector>

namespace csom::detail {

/// The part of the input that an image covers.
cv::Rect imageInInput(const NetworkDescription& network, cv::Size image);

/// Makes inputs, as a description wants them.
class NetworkInput {
 public:
  explicit NetworkInput(const NetworkDescription& network);

  /// Images × channels × height × width.
  std::vector<int> shape(int images) const;
  /// CV_32F in that shape. Images: CV_8UC3 in BGR order or CV_8UC1, of any size.
  cv::Mat of(const std::vector<cv::Mat>& images) const;

 private:
  void fill(const cv::Mat& image, float* input) const;

  const NetworkDescription& network_;
  /// For each channel of the input, its value for each value of a pixel.
  std::vector<std::array<float, 256>> input_of_pixel_;
};

}  // namespace csom::detail
