// SPDX-License-Identifier: BSD-3-Clause
// Where a camera sees a point: eqs. (1) and (2) of the paper, with lens distortion.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace csom {

/// Lens models, with the meaning of OpenCV's cv::projectPoints (PlumbBob) and
/// cv::fisheye::projectPoints (KannalaBrandt).
enum class LensDistortion { None, PlumbBob, KannalaBrandt };

/// Intrinsic calibration of one camera, in pixels. Pixel centres have whole coordinates, (0, 0)
/// is the centre of the top left pixel.
struct CameraCalibration {
  int width = 0;
  int height = 0;
  double fx = 0;
  double fy = 0;
  double cx = 0;
  double cy = 0;
  LensDistortion distortion = LensDistortion::None;
  /// PlumbBob: k1 k2 p1 p2 k3 k4 k5 k6. KannalaBrandt: k1 k2 k3 k4. Zero where not used.
  std::array<double, 8> coefficients{};
};

bool operator==(const CameraCalibration& a, const CameraCalibration& b);

/// Projects points into an image. Immutable, hence thread-safe.
class CameraProjection {
 public:
  /// Throws ConfigError naming the value if there is no such camera: no size, a focal length that
  /// is not greater than 0, a value that is not finite.
  explicit CameraProjection(const CameraCalibration& calibration);

  const CameraCalibration& calibration() const { return calibration_; }

  /// Pixel of a point in the camera's optical frame (x right, y down, z forward) [m]. Nothing if
  /// the point is not finite, is behind the camera, or so far off the axis that the polynomial of
  /// the lens has turned back there and would fold it into the image. A fisheye may see more than
  /// a half space: for KannalaBrandt the angle alone decides, and z may be negative. The pixel may
  /// lie outside of the image.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point) const;

  /// True if a pixel lies in the image: from half a pixel before the centre of the first pixel up
  /// to, and without, half a pixel behind that of the last. floor(x + 0.5) is then a pixel.
  bool contains(const Eigen::Vector2d& pixel) const;

 private:
  CameraCalibration calibration_;
  /// Largest undistorted radius (PlumbBob) or angle [rad] (KannalaBrandt) at which the lens is
  /// still one-to-one.
  double limit_;
};

}  // namespace csom
