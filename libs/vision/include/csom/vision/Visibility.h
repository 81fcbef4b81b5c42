// SPDX-License-Identifier: BSD-3-Clause
// Which points of a scan a camera really sees.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace csom {

/// A point in an image.
struct ProjectedPoint {
  Eigen::Vector2f pixel;
  float depth = 0;  ///< distance from the camera [m], > 0; not along its axis: fisheyes see behind
};

/// LiDAR and camera look from different places, so that a camera sees a near object where the LiDAR
/// looks past it at what stands behind. Returns for each point whether something nearer, itself
/// seen in the scan, hides it from the camera.
///
/// A point is hidden if points nearer by more than `margin` [m] surround it: one in each quadrant
/// around its pixel, about as far away as points are from each other in this scan, and with less
/// depth between them than between them and it. Surrounded, because on ground and walls seen at a
/// grazing angle the points on one side are rightly nearer.
std::vector<bool> hiddenPoints(const std::vector<ProjectedPoint>& points, cv::Size image_size,
                               double margin);

/// Returns for each point whether the label at its pixel may be that of something else, because a
/// border of `classes` (CV_16UC1, of the image) is near:
///
///  - Within `edge_margin` pixels of it, or next to it if points are farther apart, the depth of
///  the
///    scan jumps by more than `margin` [m], the point beyond has the same label, and the surface on
///    which the point lies goes on with another label, or nowhere. That is how labels bleed over
///    the silhouettes of objects, and how the strip between the topmost ring on an object and its
///    upper edge looks, which hiddenPoints() cannot know to be covered. What recedes as steadily as
///    its neighbours (ground) does not jump.
///  - The border itself runs through the point, as far as whole pixels can tell.
std::vector<bool> pointsAtEdges(const std::vector<ProjectedPoint>& points, const cv::Mat& classes,
                                double edge_margin, double margin);

}  // namespace csom
