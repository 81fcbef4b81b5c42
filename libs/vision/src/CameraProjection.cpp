// SPDX-License-Identifier: BSD-3-Clause
// Lens models and where they stop being one-to-one.
#include <csom/core/Error.h>
#include <csom/vision/CameraProjection.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

namespace csom {
namespace {

using Coefficients = std::array<double, 8>;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;

/// A plane image of a lens ends before 90° off the axis.
constexpr double kWidestPlaneAngle = 89.9 / 180 * kPi;

/// Radial part of the plumb bob model, as a function of s = radius².
struct RadialFactor {
  double numerator;
  double numerator_slope;
  double denominator;
  double denominator_slope;

  RadialFactor(const Coefficients& c, double s)
      : numerator(1 + s * (c[0] + s * (c[1] + s * c[4]))),
        numerator_slope(c[0] + s * (2 * c[1] + s * 3 * c[4])),
        denominator(1 + s * (c[5] + s * (c[6] + s * c[7]))),
        denominator_slope(c[5] + s * (2 * c[6] + s * 3 * c[7])) {}

  double value() const { return numerator / denominator; }
  double slope() const { return (numerator_slope - value() * denominator_slope) / denominator; }
};

/// With F the radial factor and t = (p2, p1), the distortion is x ↦ F·x + 2(t·x)·x + |x|²·t. Its
/// Jacobian is symmetric, and no eigenvalue at radius r is less than min(F, F + 2r²F') − 6r|t|.
/// Where that is positive on a whole disc, the distortion is one-to-one there: it is the gradient
/// of a strictly convex function.
double plumbBobSlope(const Coefficients& c, double radius) {
  const double s = radius * radius;
  const RadialFactor factor(c, s);
  if (factor.denominator <= 0) return 0;
  const double radial = factor.value() + 2 * s * factor.slope();
  return std::min(factor.value(), radial) - 6 * radius * std::hypot(c[2], c[3]);
}

double kannalaBrandtSlope(const Coefficients& c, double angle) {
  const double s = angle * angle;
  return 1 + s * (3 * c[0] + s * (5 * c[1] + s * (7 * c[2] + s * 9 * c[3])));
}

/// The largest angle up to `end` before which `slope` is positive everywhere.
template <class Slope>
double angleOfTurn(double end, const Slope& slope) {
  constexpr int kSteps = 20000;
  double rising = 0;
  for (int i = 1; i <= kSteps; ++i) {
    double turned = end * i / kSteps;
    if (slope(turned) > 0) {
      rising = turned;
      continue;
    }
    for (int halving = 0; halving < 50; ++halving) {
      const double middle = (rising + turned) / 2;
      (slope(middle) > 0 ? rising : turned) = middle;
    }
    return rising;
  }
  return end;
}

double limitOf(const CameraCalibration& calibration) {
  const Coefficients& c = calibration.coefficients;
  switch (calibration.distortion) {
    case LensDistortion::PlumbBob:
      return std::tan(angleOfTurn(kWidestPlaneAngle,
                                  [&](double angle) { return plumbBobSlope(c, std::tan(angle)); }));
    case LensDistortion::KannalaBrandt:
      return angleOfTurn(kPi, [&](double angle) { return kannalaBrandtSlope(c, angle); });
    case LensDistortion::None:
      break;
  }
  return std::numeric_limits<double>::infinity();
}

Vector2d plumbBob(const Coefficients& c, const Vector2d& x) {
  const double s = x.squaredNorm();
  const Vector2d t(c[3], c[2]);
  return (RadialFactor(c, s).value() + 2 * t.dot(x)) * x + s * t;
}

double kannalaBrandt(const Coefficients& c, double angle) {
  const double s = angle * angle;
  return angle * (1 + s * (c[0] + s * (c[1] + s * (c[2] + s * c[3]))));
}

template <class Value>
[[noreturn]] void reject(const char* name, Value value, const char* wanted) {
  std::ostringstream message;
  message << "camera calibration: " << name << " = " << value << " is not " << wanted;
  throw ConfigError(message.str());
}

void validate(const CameraCalibration& c) {
  if (c.width <= 0) reject("width", c.width, "a number of pixels greater than 0");
  if (c.height <= 0) reject("height", c.height, "a number of pixels greater than 0");
  for (const auto& [name, value] : {std::pair{"fx", c.fx}, {"fy", c.fy}}) {
    if (!(value > 0) || !std::isfinite(value))
      reject(name, value, "a focal length greater than 0 pixels");
  }
  for (const auto& [name, value] : {std::pair{"cx", c.cx}, {"cy", c.cy}}) {
    if (!std::isfinite(value)) reject(name, value, "a finite pixel coordinate");
  }
  for (std::size_t i = 0; i < c.coefficients.size(); ++i) {
    const std::string name = "distortion coefficient " + std::to_string(i + 1);
    if (!std::isfinite(c.coefficients[i])) reject(name.c_str(), c.coefficients[i], "finite");
  }
}

}  // namespace

bool operator==(const CameraCalibration& a, const CameraCalibration& b) {
  return a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy &&
         a.cx == b.cx && a.cy == b.cy && a.distortion == b.distortion &&
         a.coefficients == b.coefficients;
}

CameraProjection::CameraProjection(const CameraCalibration& calibration)
    : calibration_((validate(calibration), calibration)), limit_(limitOf(calibration)) {}

std::optional<Vector2d> CameraProjection::project(const Vector3d& point) const {
  Vector2d x = point.head<2>();
  if (calibration_.distortion == LensDistortion::KannalaBrandt) {
    const double radius = x.norm();
    const double angle = std::atan2(radius, point.z());
    if (!(angle < limit_)) return std::nullopt;
    if (radius > 0) x *= kannalaBrandt(calibration_.coefficients, angle) / radius;
  } else {
    if (!(point.z() > 0)) return std::nullopt;
    x /= point.z();
    if (!(x.norm() < limit_)) return std::nullopt;
    if (calibration_.distortion == LensDistortion::PlumbBob)
      x = plumbBob(calibration_.coefficients, x);
  }
  const Vector2d pixel(calibration_.fx * x.x() + calibration_.cx,
                       calibration_.fy * x.y() + calibration_.cy);
  if (!pixel.allFinite()) return std::nullopt;
  return pixel;
}

bool CameraProjection::contains(const Vector2d& pixel) const {
  return pixel.x() >= -0.5 && pixel.x() < calibration_.width - 0.5 &&  //
         pixel.y() >= -0.5 && pixel.y() < calibration_.height - 0.5;
}

}  // namespace csom
