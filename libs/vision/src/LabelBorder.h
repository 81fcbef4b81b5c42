// SPDX-License-Identifier: BSD-3-Clause
// Where borders between labels run, to a fraction of a pixel.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace csom::detail {

/// How far [px] a place (in the image) lies inside of the region of its class, measured along x or
/// along y, whichever is less; infinite if no pixel next to it has another class.
///
/// A border is a staircase of pixels; the line through its steps says where it really runs, which
/// may be on the other side of the place: then the distance is negative. Classes: CV_16UC1.
float distanceToBorder(const cv::Mat& classes, const Eigen::Vector2f& pixel);

}  // namespace csom::detail
