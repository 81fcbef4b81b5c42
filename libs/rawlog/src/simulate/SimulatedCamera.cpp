// SPDX-License-Identifier: BSD-3-Clause
// A pinhole camera's two images: what it sees, and of which class that is.
#include <mrpt/obs/CObservationImage.h>

#include <algorithm>
#include <cmath>

#include "simulate/SimulatedSensors.h"

namespace csom::detail {
namespace {

using Eigen::Vector3d;
using mrpt::img::CImage;
using mrpt::obs::CObservationImage;

constexpr Color kSky{178, 204, 230};

/// Body (x forward, y left, z up) ← optical axes (x right, y down, z forward).
Eigen::Matrix3d opticalAxes() {
  Eigen::Matrix3d axes;
  axes << 0, 0, 1,  //
      -1, 0, 0,     //
      0, -1, 0;
  return axes;
}

/// Lambert's law under a high sun, with plenty of light from the sky.
Color shaded(const SurfaceHit& hit) {
  const Vector3d sun = Vector3d(0.4, -0.5, 0.77).normalized();
  const double light = 0.55 + 0.45 * std::max(0.0, hit.normal.dot(sun));
  Color color{};
  for (std::size_t i = 0; i < 3; ++i)
    color[i] = static_cast<std::uint8_t>(std::lround(light * hit.color[i]));
  return color;
}

mrpt::img::TCamera intrinsics(const CameraModel& model) {
  mrpt::img::TCamera camera;
  camera.ncols = static_cast<unsigned>(model.width);
  camera.nrows = static_cast<unsigned>(model.height);
  camera.cameraName = model.mount.label;
  // Pixel centres have whole coordinates, as in OpenCV.
  camera.setIntrinsicParamsFromValues(model.focalLength(), model.focalLength(),
                                      (model.width - 1) / 2.0, (model.height - 1) / 2.0);
  return camera;
}

CObservationImage::Ptr imageObservation(const CameraModel& model, const Moment& moment,
                                        const std::string& label,
                                        mrpt::img::TImageChannels channels) {
  auto observation = CObservationImage::Create();
  observation->sensorLabel = label;
  observation->timestamp = moment.timestamp;
  observation->cameraParams = intrinsics(model);
  const mrpt::poses::CPose3D optical(0, 0, 0, -M_PI / 2, 0, -M_PI / 2);
  observation->cameraPose = toMrpt(model.mount) + optical;
  observation->image =
      CImage(static_cast<unsigned>(model.width), static_cast<unsigned>(model.height), channels);
  return observation;
}

}  // namespace

Sensed sense(const CameraModel& model, const World& world, const Moment& moment,
             Random& /*random*/) {
  const auto picture = imageObservation(model, moment, model.mount.label, mrpt::img::CH_RGB);
  const auto classes =
      imageObservation(model, moment, model.mount.label + "_labels", mrpt::img::CH_GRAY);
  const Eigen::Isometry3d body = moment.robot() * model.mount.pose();
  const Eigen::Matrix3d axes = body.linear() * opticalAxes();
  const double cx = (model.width - 1) / 2.0;
  const double cy = (model.height - 1) / 2.0;
  for (int v = 0; v < model.height; ++v) {
    auto* bgr = picture->image.ptrLine<std::uint8_t>(static_cast<unsigned>(v));
    auto* ids = classes->image.ptrLine<std::uint8_t>(static_cast<unsigned>(v));
    for (int u = 0; u < model.width; ++u, bgr += 3, ++ids) {
      const Vector3d direction =
          (axes * Vector3d(u - cx, v - cy, model.focalLength())).normalized();
      const auto hit = world.castRay(body.translation(), direction, model.max_range, moment.time);
      const Color color = hit ? shaded(*hit) : kSky;
      std::reverse_copy(color.begin(), color.end(), bgr);
      *ids = static_cast<std::uint8_t>(hit ? hit->class_id : kFreeClass);
    }
  }
  return {{picture, classes}, 0};
}

}  // namespace csom::detail
