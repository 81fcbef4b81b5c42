// SPDX-License-Identifier: BSD-3-Clause
// Lines and arcs through waypoints.
#include <csom/eval/RobotPath.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace csom {

Eigen::Isometry3d PlanarPose::isometry() const {
  Eigen::Isometry3d robot = Eigen::Isometry3d::Identity();
  robot.translate(Eigen::Vector3d(x, y, 0));
  robot.rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  return robot;
}

namespace {

using Eigen::Vector2d;

double headingOf(const Vector2d& direction) {
  return std::atan2(direction.y(), direction.x());
}

/// Turn from one heading to the next, in (−π, π].
double turnBetween(const Vector2d& from, const Vector2d& to) {
  return std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
}

double roundTo(double value, double unit) {
  return std::round(value / unit) * unit;
}

PlanarPose rounded(const PlanarPose& pose) {
  return {roundTo(pose.x, 1e-6), roundTo(pose.y, 1e-6), roundTo(pose.yaw, 1e-7)};
}

[[noreturn]] void failOnLeg(std::size_t leg, const std::string& reason) {
  throw std::invalid_argument("between waypoints " + std::to_string(leg + 1) + " and " +
                              std::to_string(leg + 2) + ": " + reason);
}

}  // namespace

RobotPath RobotPath::drive(const std::vector<Vector2d>& waypoints, double turn_radius,
                           double speed) {
  if (waypoints.size() < 2) throw std::invalid_argument("a path needs two waypoints or more");
  if (!(speed > 0)) throw std::invalid_argument("speed must be above 0 m/s");
  if (!(turn_radius > 0)) throw std::invalid_argument("turn_radius must be above 0 m");

  RobotPath path;
  path.speed_ = speed;
  double used = 0;  // metres of the current leg that the last corner's arc has taken
  for (std::size_t i = 0; i + 1 < waypoints.size(); ++i) {
    const Vector2d leg = waypoints[i + 1] - waypoints[i];
    if (!(leg.norm() > 0)) failOnLeg(i, "no distance; remove one of them");
    const Vector2d direction = leg.normalized();
    const bool last = i + 2 == waypoints.size();
    const Vector2d next = last ? direction : (waypoints[i + 2] - waypoints[i + 1]).eval();
    const double turn = turnBetween(direction, next);
    const double cut = turn_radius * std::tan(std::abs(turn) / 2);
    if (!(used + cut <= leg.norm()))
      failOnLeg(i, "too short for the arcs at its ends; lengthen it or lower turn_radius");

    const Vector2d start = waypoints[i] + used * direction;
    path.append({start.x(), start.y(), headingOf(direction)}, leg.norm() - used - cut, 0);
    if (turn != 0) {
      const Vector2d corner = waypoints[i + 1] - cut * direction;
      path.append({corner.x(), corner.y(), headingOf(direction)}, turn_radius * std::abs(turn),
                  std::copysign(1 / turn_radius, turn));
    }
    used = cut;
  }
  path.duration_ = path.length_ / speed;
  return path;
}

RobotPath RobotPath::stations(const std::vector<PlanarPose>& poses, double dwell) {
  if (poses.empty()) throw std::invalid_argument("a robot needs a station");
  if (!(dwell > 0)) throw std::invalid_argument("dwell must be above 0 s");
  RobotPath path;
  path.stations_ = poses;
  path.dwell_ = dwell;
  path.duration_ = dwell * static_cast<double>(poses.size());
  return path;
}

void RobotPath::append(const PlanarPose& start, double length, double curvature) {
  segments_.push_back({start, length_, length, curvature});
  length_ += length;
}

PlanarPose RobotPath::at(double time) const {
  if (!stations_.empty()) {
    const double last = static_cast<double>(stations_.size() - 1);
    return rounded(
        stations_[static_cast<std::size_t>(std::clamp(std::floor(time / dwell_), 0.0, last))]);
  }
  const double s = std::clamp(speed_ * time, 0.0, length_);
  const auto next = std::upper_bound(
      segments_.begin() + 1, segments_.end(), s,
      [](double position, const Segment& segment) { return position < segment.begin; });
  const Segment& segment = *(next - 1);
  const double along = s - segment.begin;
  const PlanarPose& p = segment.start;
  if (segment.curvature == 0)
    return rounded({p.x + along * std::cos(p.yaw), p.y + along * std::sin(p.yaw), p.yaw});
  const double radius = 1 / segment.curvature;
  const double yaw = p.yaw + along * segment.curvature;
  return rounded({p.x + radius * (std::sin(yaw) - std::sin(p.yaw)),
                  p.y - radius * (std::cos(yaw) - std::cos(p.yaw)), yaw});
}

}  // namespace csom
