// SPDX-License-Identifier: BSD-3-Clause
// A scan with the images that gave it its labels.
#pragma once

#include <csom/vision/CameraProjection.h>
#include <csom/vision/PointLabelling.h>
#include <csom/vision/SemanticImage.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace csom {

/// A scan and the images that labelled it, for pictures. Copies share pixels.
struct LabelledScan {
  struct View {
    std::string sensor_label;
    double timestamp = 0;    ///< of the image [s since 1970]
    std::size_t number = 0;  ///< of the image among those of its camera
    cv::Mat photo;           ///< what the camera saw; empty if only ids are known
    std::shared_ptr<const CameraProjection> projection;
    Eigen::Isometry3d camera_from_points;
    std::shared_ptr<const SemanticImage> labels;
  };
  std::vector<Eigen::Vector3f> points;  ///< in the frame of their sensor
  LabelledPoints labelled;              ///< its views are indices into `views`
  std::vector<View> views;
};

using LabelledScanObserver = std::function<void(const LabelledScan&)>;

}  // namespace csom
