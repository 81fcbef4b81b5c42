// SPDX-License-Identifier: BSD-3-Clause
// Labelled points on their way through the preparation of a scan.
#pragma once

#include <csom/core/types.h>

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace csom::detail {

/// Points relative to the scan's origin. Without labels and scores all are of class 0, free.
struct PointSet {
  std::vector<Eigen::Vector3f> points;
  std::vector<ClassId> labels;
  std::vector<float> scores;              ///< rows of one score a class
  std::vector<RangeImage::Pixel> pixels;  ///< of an image, or none

  void append(const PointSet& other) {
    points.insert(points.end(), other.points.begin(), other.points.end());
    labels.insert(labels.end(), other.labels.begin(), other.labels.end());
    scores.insert(scores.end(), other.scores.begin(), other.scores.end());
  }
};

}  // namespace csom::detail
