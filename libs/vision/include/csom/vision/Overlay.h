// SPDX-License-Identifier: BSD-3-Clause
// Pictures of what a camera saw and what became of it.
#pragma once

#include <csom/vision/PointLabelling.h>

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace csom {

/// Colours of the classes by id: red, green, blue.
using ClassColors = std::vector<std::array<std::uint8_t, 3>>;

/// The image (CV_8UC3 BGR or CV_8UC1) with every pixel tinted in the colour of its class; pixels
/// without a class keep the image's own colour. Returns CV_8UC3 BGR.
cv::Mat drawSegmentation(const cv::Mat& image, const SemanticImage& labels,
                         const ClassColors& colors);

/// The darkened image with a dot for each point that lies in it: in the colour of its class if it
/// was labelled, dark gray if it was hidden, at an edge, or dropped. Far points are drawn first.
cv::Mat drawLabelledPoints(const cv::Mat& image, const CameraView& view, int view_number,
                           const std::vector<Eigen::Vector3f>& points,
                           const LabelledPoints& labelled, const ClassColors& colors);

}  // namespace csom
