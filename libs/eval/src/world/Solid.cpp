// SPDX-License-Identifier: BSD-3-Clause
// Geometry of boxes, upright cylinders and spheres.
#include <csom/eval/Solid.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace csom {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// The part of a ray that lies in a solid, cut down half-space by half-space.
struct Span {
  double begin = -std::numeric_limits<double>::infinity();
  double end = std::numeric_limits<double>::infinity();
  Vector3d normal = Vector3d::UnitZ();  ///< of the surface at `begin`

  void cut(double enter, double leave, const Vector3d& enter_normal) {
    if (enter > begin) {
      begin = enter;
      normal = enter_normal;
    }
    end = std::min(end, leave);
  }
  void clear() { end = -std::numeric_limits<double>::infinity(); }
};

/// Cuts to |coordinate| ≤ half along one axis.
void cutSlab(Span& span, const Vector3d& origin, const Vector3d& direction, int axis, double half) {
  const double o = origin[axis];
  const double d = direction[axis];
  if (d == 0) {
    if (std::abs(o) > half) span.clear();
    return;
  }
  const Vector3d normal = Vector3d::Unit(axis) * (d > 0 ? -1.0 : 1.0);
  const double a = (-half - o) / d;
  const double b = (half - o) / d;
  span.cut(std::min(a, b), std::max(a, b), normal);
}

/// Cuts to the points whose first `dimensions` coordinates are at most `radius` from the origin.
void cutRound(Span& span, const Vector3d& origin, const Vector3d& direction, int dimensions,
              double radius) {
  const auto o = origin.head(dimensions);
  const auto d = direction.head(dimensions);
  const double a = d.squaredNorm();
  const double c = o.squaredNorm() - radius * radius;
  if (a == 0) {
    if (c > 0) span.clear();
    return;
  }
  const double b = o.dot(d);
  const double discriminant = b * b - a * c;
  if (discriminant < 0) {
    span.clear();
    return;
  }
  const double root = std::sqrt(discriminant);
  const double enter = (-b - root) / a;
  Vector3d normal = Vector3d::Zero();
  normal.head(dimensions) = (o + enter * d) / radius;
  span.cut(enter, (-b + root) / a, normal);
}

/// Squared distance from `point` to the nearest point of a box, in the first `dimensions` axes.
double squaredDistance(const Vector3d& point, const AlignedBox3d& box, int dimensions) {
  const Vector3d nearest = point.cwiseMax(box.min()).cwiseMin(box.max());
  return (point - nearest).head(dimensions).squaredNorm();
}

}  // namespace

Solid::Solid(Shape shape, const Vector3d& center, const Vector3d& half_size, double yaw)
    : shape_(shape),
      center_(center),
      half_size_(half_size),
      cos_yaw_(std::cos(yaw)),
      sin_yaw_(std::sin(yaw)) {
  if (!center.allFinite() || !std::isfinite(yaw) || !(half_size.minCoeff() > 0) ||
      !half_size.allFinite())
    throw std::invalid_argument("a solid needs a finite centre and sizes above 0");
}

Solid Solid::box(const Vector3d& center, const Vector3d& size, double yaw) {
  return Solid(Shape::Box, center, size / 2, yaw);
}

Solid Solid::cylinder(const Vector3d& center, double radius, double height) {
  return Solid(Shape::Cylinder, center, {radius, radius, height / 2}, 0);
}

Solid Solid::sphere(const Vector3d& center, double radius) {
  return Solid(Shape::Sphere, center, Vector3d::Constant(radius), 0);
}

Vector3d Solid::turned(const Vector3d& v) const {
  return {cos_yaw_ * v.x() + sin_yaw_ * v.y(), cos_yaw_ * v.y() - sin_yaw_ * v.x(), v.z()};
}

Vector3d Solid::turnedBack(const Vector3d& v) const {
  return {cos_yaw_ * v.x() - sin_yaw_ * v.y(), cos_yaw_ * v.y() + sin_yaw_ * v.x(), v.z()};
}

AlignedBox3d Solid::bounds() const {
  Vector3d reach = half_size_;
  reach.x() = std::abs(cos_yaw_) * half_size_.x() + std::abs(sin_yaw_) * half_size_.y();
  reach.y() = std::abs(sin_yaw_) * half_size_.x() + std::abs(cos_yaw_) * half_size_.y();
  return {center_ - reach, center_ + reach};
}

bool Solid::contains(const Vector3d& point) const {
  const Vector3d p = turned(point - center_);
  switch (shape_) {
    case Shape::Box:
      return (p.cwiseAbs().array() <= half_size_.array()).all();
    case Shape::Cylinder:
      return std::abs(p.z()) <= half_size_.z() &&
             p.head<2>().squaredNorm() <= half_size_.x() * half_size_.x();
    case Shape::Sphere:
      return p.squaredNorm() <= half_size_.x() * half_size_.x();
  }
  return false;
}

bool Solid::touches(const AlignedBox3d& cube) const {
  const double radius = half_size_.x();
  if (shape_ == Shape::Sphere) return squaredDistance(center_, cube, 3) < radius * radius;
  if (!(std::abs(cube.center().z() - center_.z()) < half_size_.z() + cube.sizes().z() / 2))
    return false;
  if (shape_ == Shape::Cylinder) return squaredDistance(center_, cube, 2) < radius * radius;

  // Two rectangles: apart if they are along one of the four directions of their edges.
  const Vector3d offset = cube.center() - center_;
  const Vector3d half = cube.sizes() / 2;
  const Vector3d reach = bounds().sizes() / 2;
  if (!(std::abs(offset.x()) < reach.x() + half.x())) return false;
  if (!(std::abs(offset.y()) < reach.y() + half.y())) return false;
  const Vector3d local = turned(offset);
  const double c = std::abs(cos_yaw_);
  const double s = std::abs(sin_yaw_);
  return std::abs(local.x()) < half_size_.x() + c * half.x() + s * half.y() &&
         std::abs(local.y()) < half_size_.y() + s * half.x() + c * half.y();
}

bool Solid::covers(const AlignedBox3d& cube) const {
  for (int i = 0; i < 8; ++i) {
    if (!contains(cube.corner(static_cast<AlignedBox3d::CornerType>(i)))) return false;
  }
  return true;
}

std::optional<Solid::Entry> Solid::enter(const Vector3d& origin, const Vector3d& direction) const {
  const Vector3d o = turned(origin - center_);
  const Vector3d d = turned(direction);
  Span span;
  switch (shape_) {
    case Shape::Box:
      for (int axis = 0; axis < 3; ++axis) cutSlab(span, o, d, axis, half_size_[axis]);
      break;
    case Shape::Cylinder:
      cutRound(span, o, d, 2, half_size_.x());
      cutSlab(span, o, d, 2, half_size_.z());
      break;
    case Shape::Sphere:
      cutRound(span, o, d, 3, half_size_.x());
      break;
  }
  if (span.begin > span.end || span.begin < 0) return std::nullopt;
  return Entry{span.begin, turnedBack(span.normal)};
}

}  // namespace csom
