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
/// without a class keep the image's own colour. Returns CV_8UC3 BGR. Throws std::invalid_argument
/// if the image has another type, or another size than the labels.
cv::Mat drawSegmentation(const cv::Mat& image, const SemanticImage& labels,
                         const ClassColors& colors);

/// The darkened image with a dot for each point of which this view decided: in the colour of its
/// class if it was labelled, small and gray if it was hidden, at an edge, or dropped. Points that
/// another view labelled are left out, since they may be hidden in this one. Near points cover far
/// ones; dots are larger where there are fewer. Images less than 640 pixels wide are enlarged by a
/// whole factor. Returns CV_8UC3 BGR. Throws std::invalid_argument if the image has another type,
/// or another size than the view, or if `labelled` is not about these points.
cv::Mat drawLabelledPoints(const cv::Mat& image, const CameraView& view, int view_number,
                           const std::vector<Eigen::Vector3f>& points,
                           const LabelledPoints& labelled, const ClassColors& colors);

/// Classes that some pixel has, ascending.
std::vector<ClassId> classesShown(const SemanticImage& labels);

/// Bytes of a JPEG file of a picture, good enough to look at.
std::vector<std::uint8_t> encodeJpeg(const cv::Mat& picture);

}  // namespace csom
