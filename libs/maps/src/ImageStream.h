// SPDX-License-Identifier: BSD-3-Clause
// The images of one camera that scans may still need.
#pragma once

#include <csom/vision/CameraProjection.h>
#include <csom/vision/SemanticImage.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <deque>
#include <memory>
#include <opencv2/core/mat.hpp>

namespace csom {

/// An image, where its camera was, and what its pixels show once that has been asked for.
struct StreamedImage {
  double time = 0;         ///< [s since 1970]
  std::size_t number = 0;  ///< of this camera, from 0
  cv::Mat pixels;          ///< of the camera, or raw ids
  cv::Mat photo;           ///< for pictures; may be empty
  std::shared_ptr<const CameraProjection> projection;
  Eigen::Isometry3d camera_in_map = Eigen::Isometry3d::Identity();  ///< optical frame
  std::shared_ptr<const SemanticImage> labels;                      ///< null: not asked for yet
  bool used = false;
};

/// Images by time, at most kCapacity of them: beyond that the oldest is given up. A copy shares the
/// pixels.
class ImageStream {
 public:
  static constexpr std::size_t kCapacity = 32;

  /// False if there is an image of this very time already: two cameras share the sensor label.
  bool add(StreamedImage image);
  /// The nearest in time, if within `max_offset`; of two equally near ones the earlier. Null if
  /// there is none. Valid until the next call of add() or forgetBefore().
  StreamedImage* nearest(double time, double max_offset);
  /// True if no image that is still to come can be nearer to `time` than those that are here,
  /// provided that images come in order.
  bool reaches(double time) const { return !images_.empty() && images_.back().time >= time; }
  void forgetBefore(double time);
  void clear() { images_.clear(); }

  const std::deque<StreamedImage>& images() const { return images_; }

 private:
  std::deque<StreamedImage> images_;  ///< in order of time
};

}  // namespace csom
