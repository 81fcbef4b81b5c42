// SPDX-License-Identifier: BSD-3-Clause
// Which points of a scan a camera really sees.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace csom {

/// A point in an image.
struct ProjectedPoint {
  Eigen::Vector2f pixel;
  float depth = 0;  ///< distance from the camera along its optical axis [m], > 0
};

/// LiDAR and camera look from different places, so that a camera sees a near object where the LiDAR
/// looks past it at what stands behind. Returns for each point whether something nearer, itself seen
/// in the scan, hides it from the camera. docs/camera.md explains the rule and gives its figures.
/// `margin`: what is nearer by less does not hide [m].
std::vector<bool> hiddenPoints(const std::vector<ProjectedPoint>& points, cv::Size image_size,
                               double margin);

/// Returns for each point whether a label border of `classes` (CV_16UC1, of the image) lies within
/// `edge_margin` pixels and the depth of the scan jumps there by more than `margin` [m].
std::vector<bool> pointsAtEdges(const std::vector<ProjectedPoint>& points, const cv::Mat& classes,
                                double edge_margin, double margin);

}  // namespace csom
