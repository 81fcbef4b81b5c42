// SPDX-License-Identifier: BSD-3-Clause
// The image that an observation carries, with the camera that took it.
#pragma once

#include <csom/vision/CameraProjection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>

#include <opencv2/core/mat.hpp>
#include <optional>

namespace csom {

struct CameraImage {
  cv::Mat
      pixels;  ///< CV_8UC3 in BGR order, CV_8UC1 or CV_16UC1; shares memory with the observation
  CameraCalibration calibration;
  mrpt::poses::CPose3D pose_on_robot;  ///< of the optical frame: x right, y down, z forward
};

/// The image of a CObservationImage, the left one of a CObservationStereoImages, the intensity
/// image of a CObservation3DRangeScan. Nothing for any other kind, and for a range scan without an
/// intensity image. Loads it if it is a file of its own. Throws std::exception if the file is
/// missing or damaged, if the camera is not calibrated, or for another size than the image has.
std::optional<CameraImage> toCameraImage(const mrpt::obs::CObservation& observation);

}  // namespace csom
