// SPDX-License-Identifier: BSD-3-Clause
// The image that an observation carries, with the camera that took it.
#include <csom/maps/CameraImage.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationStereoImages.h>

#include <stdexcept>
#include <string>

namespace csom {
namespace {

using mrpt::img::CImage;
using mrpt::img::TCamera;

std::string sizeOf(std::int64_t width, std::int64_t height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

CameraCalibration calibrationOf(const TCamera& camera) {
  CameraCalibration calibration;
  calibration.width = static_cast<int>(camera.ncols);
  calibration.height = static_cast<int>(camera.nrows);
  calibration.fx = camera.fx();
  calibration.fy = camera.fy();
  calibration.cx = camera.cx();
  calibration.cy = camera.cy();
  switch (camera.distortion) {
    case mrpt::img::DistortionModel::none:
      break;
    case mrpt::img::DistortionModel::plumb_bob:
      calibration.distortion = LensDistortion::PlumbBob;
      calibration.coefficients = camera.dist;
      break;
    case mrpt::img::DistortionModel::kannala_brandt:
      calibration.distortion = LensDistortion::KannalaBrandt;
      // MRPT leaves the places of plumb bob's tangential coefficients empty.
      calibration.coefficients = {camera.k1(), camera.k2(), camera.k3(), camera.k4()};
      break;
  }
  return calibration;
}

cv::Mat pixelsOf(const CImage& image) {
  const bool in_file = image.isExternallyStored();
  std::string place;
  if (in_file) image.getExternalStorageFileAbsolutePath(place);
  cv::Mat pixels;
  try {
    image.forceLoad();
    pixels = image.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
  } catch (const std::exception&) {
    // Said below; MRPT's own text spans many lines.
  }
  if (pixels.empty()) {
    throw std::runtime_error(in_file ? "its image file is missing or damaged: " + place
                                     : "it holds no image");
  }
  const int type = pixels.type();
  if (type != CV_8UC3 && type != CV_8UC1 && type != CV_16UC1)
    throw std::runtime_error("its image is neither colour nor gray with 8 or 16 bits");
  return pixels;
}

CameraImage cameraImage(const CImage& image, const TCamera& camera,
                        const mrpt::poses::CPose3D& pose) {
  CameraImage result;
  result.calibration = calibrationOf(camera);
  if (!(camera.fx() > 0 && camera.fy() > 0) || camera.ncols == 0 || camera.nrows == 0)
    throw std::runtime_error("its camera is not calibrated (cameraParams)");
  result.pixels = pixelsOf(image);
  if (result.pixels.cols != result.calibration.width ||
      result.pixels.rows != result.calibration.height)
    throw std::runtime_error("its image has " + sizeOf(result.pixels.cols, result.pixels.rows) +
                             " pixels, but its calibration is for " +
                             sizeOf(camera.ncols, camera.nrows));
  result.pose_on_robot = pose;
  return result;
}

}  // namespace

std::optional<CameraImage> toCameraImage(const mrpt::obs::CObservation& observation) {
  if (const auto* mono = dynamic_cast<const mrpt::obs::CObservationImage*>(&observation))
    return cameraImage(mono->image, mono->cameraParams, mono->cameraPose);
  if (const auto* stereo = dynamic_cast<const mrpt::obs::CObservationStereoImages*>(&observation))
    return cameraImage(stereo->imageLeft, stereo->leftCamera,
                       mrpt::poses::CPose3D(stereo->cameraPose));
  const auto* range = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation);
  if (range == nullptr || !range->hasIntensityImage) return std::nullopt;
  return cameraImage(range->intensityImage, range->cameraParamsIntensity,
                     range->sensorPose + range->relativePoseIntensityWRTDepth);
}

}  // namespace csom
