// SPDX-License-Identifier: BSD-3-Clause
// surface-csom written straight from its equations: double precision, all pairs, no shortcuts. It
// shares no code with the library but its types. A decision that the library's single precision may
// take the other way is not an error: the voxels that depend on one are told.
#pragma once

#include <csom/core/Options.h>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace csom::test {

class NaiveSurfaceOracle {
 public:
  using Cell = std::array<std::int64_t, 3>;  // x, y, z
  using Vector = std::vector<double>;

  struct Point {
    Eigen::Vector3d xyz;  ///< voxels
    Vector c;
  };

  /// L_J of a voxel's block, in voxels.
  using LengthOf = std::function<double(const Cell&)>;

  /// Points in units of voxels.
  NaiveSurfaceOracle(const Options& options, std::vector<Point> points)
      : o_(options), points_(std::move(points)), surfaces_(points_.size()) {
    for (std::size_t p = 0; p < points_.size(); ++p) surfaces_[p] = surfaceOf(p);
  }

  /// Kernel mass by class of all voxels that receive any.
  std::map<Cell, Vector> increments(const LengthOf& lengthOf) {
    std::map<Cell, Vector> mass;
    for (const Cell& v : cellsInReach()) mass[v] = massOf(v, lengthOf(v));
    return mass;
  }

  /// The voxel's value depends on a decision that rounding may turn round.
  bool isUndecided(const Cell& v) const { return undecided_.count(v) > 0; }

 private:
  struct Surface {
    bool free = false;
    bool plane = false;
    bool undecided = false;
    double length = 0;
    double half_thickness = 0;
    double own_side = 0;
    double density = 1;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();

    double reach() const { return std::max(length + own_side, 0.87); }
  };

  static double kernel(double t) {
    if (t >= 1) return 0;
    const double turn = 2 * M_PI * t;
    return (2 + std::cos(turn)) / 3 * (1 - t) + std::sin(turn) / (2 * M_PI);
  }

  static bool close(double a, double b, double margin) { return std::abs(a - b) < margin; }

  Surface surfaceOf(std::size_t p) const {
    Surface s;
    s.free = points_[p].c[0] > 0.5;
    s.undecided = close(points_[p].c[0], 0.5, 1e-5);
    if (s.free) {
      s.length = o_.kernelLengthMin() / o_.resolution;
      return s;
    }
    const double cell = std::clamp(o_.scan.ds_resolution / o_.resolution, 1.0, 16.0);
    const double widest = std::min(o_.surface.gap * cell, 16.0);
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t q = 0; q < points_.size(); ++q) {
      const double distance = (points_[q].xyz - points_[p].xyz).norm();
      if (q == p || points_[q].c[0] > 0.5 || distance > 1.6 * widest) continue;
      near.emplace_back(distance, q);
      s.undecided = s.undecided || close(distance, 1.5 * widest, 1e-4);
    }
    std::sort(near.begin(), near.end());
    while (!near.empty() && near.back().first >= 1.5 * widest) near.pop_back();
    const auto wanted = static_cast<std::size_t>(o_.surface.neighbours);
    if (near.size() > wanted) {
      s.undecided = s.undecided || close(near[wanted].first, near[wanted - 1].first, 1e-4);
      near.resize(wanted);
    }
    if (near.size() < 3) {
      setLength(1.5 * widest, 1.1, cell, s);
      return s;
    }
    const auto spacingTo = [&](std::size_t n) {
      return near[n - 1].first * std::sqrt(M_PI / (static_cast<double>(n) + 0.5));
    };
    double sum = 1;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& [distance, q] : near) {
      const double weight = kernel(distance / (2.5 * spacingTo(near.size())));
      sum += weight;
      mean += weight * (points_[q].xyz - points_[p].xyz);
    }
    mean /= sum;
    Eigen::Matrix3d covariance = mean * mean.transpose() / sum;
    for (const auto& [distance, q] : near) {
      const double weight = kernel(distance / (2.5 * spacingTo(near.size())));
      const Eigen::Vector3d offset = points_[q].xyz - points_[p].xyz - mean;
      covariance += weight * offset * offset.transpose() / sum;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    const Eigen::Vector3d l = solver.eigenvalues();
    const double noise = 1e-4 * l[2];
    s.undecided = s.undecided || close(l[0], 0.5 * l[1], noise);
    if (!o_.surface.planes || l[0] >= 0.5 * l[1]) {
      setLength(spacingTo(3), cell, cell, s);
      return s;
    }
    s.plane = true;
    s.normal = solver.eigenvectors().col(0);
    s.half_thickness = o_.surface.thickness * s.normal.lpNorm<1>() / 2;
    const Eigen::Vector3d& at = points_[p].xyz;
    const Eigen::Vector3d center = at.array().floor() + 0.5;
    if (s.normal.dot(center - at) < 0) s.normal = -s.normal;
    s.own_side = std::max(s.half_thickness, s.normal.dot(center - at) + 1e-4);
    const double breadth = std::sqrt(l[1]) - std::sqrt(std::max(0.0, l[0]));
    // Hits on a line have no normal that single precision could tell.
    s.undecided =
        s.undecided || close(breadth, 0.5 * std::sqrt(l[2]), 1e-3) || l[1] - l[0] < 2e-2 * l[2];
    setLength(spacingTo(3), breadth >= 0.5 * std::sqrt(l[2]) ? widest : cell, cell, s);
    return s;
  }

  void setLength(double spacing, double limit, double cell, Surface& s) const {
    s.density = std::min(1.0, std::pow(1.3 * cell / spacing, 2));
    s.length = std::min(
        24.0, o_.surface.reach * std::max(1.1, std::min(spacing, limit)) * (s.plane ? 1.0 : 0.85));
  }

  std::set<Cell> cellsInReach() const {
    std::set<Cell> cells;
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const auto reach = static_cast<std::int64_t>(std::ceil(surfaces_[p].reach() + 0.5));
      const Eigen::Vector3d& at = points_[p].xyz;
      const Cell middle{floorOf(at.x()), floorOf(at.y()), floorOf(at.z())};
      for (std::int64_t z = -reach; z <= reach; ++z)
        for (std::int64_t y = -reach; y <= reach; ++y)
          for (std::int64_t x = -reach; x <= reach; ++x)
            cells.insert({middle[0] + x, middle[1] + y, middle[2] + z});
    }
    return cells;
  }

  static std::int64_t floorOf(double v) { return static_cast<std::int64_t>(std::floor(v)); }

  Vector massOf(const Cell& v, double length) {
    const Eigen::Vector3d center(static_cast<double>(v[0]) + 0.5, static_cast<double>(v[1]) + 0.5,
                                 static_cast<double>(v[2]) + 0.5);
    double votes = 0;
    double support = 0;
    double dense = 0;
    double free = 0;
    Vector classes(static_cast<std::size_t>(o_.number_of_classes));
    bool undecided = false;
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const Surface& s = surfaces_[p];
      const Eigen::Vector3d d = center - points_[p].xyz;
      if (s.undecided && d.norm() < s.reach() + 1) undecided = true;
      if (s.free) {
        free += kernel(d.norm() / s.length);
        continue;
      }
      const double off = s.plane ? s.normal.dot(d) : 0;
      const double along = std::sqrt(std::max(0.0, d.squaredNorm() - off * off));
      const double mass = kernel(along / s.length);
      if (s.plane && mass > 1e-6)
        undecided = undecided || close(off, s.own_side, 5e-5) ||
                    close(off, -s.half_thickness, 1e-3) ||
                    close(std::abs(off), s.half_thickness + 0.5, 1e-3);
      const double hit = d.lpNorm<Eigen::Infinity>() < 0.5 ? o_.surface.hit_weight : 0;
      undecided = undecided || close(d.lpNorm<Eigen::Infinity>(), 0.5, 1e-4);
      if (!s.plane || (-s.half_thickness <= off && off <= s.own_side)) votes += mass;
      if (!s.plane || std::abs(off) <= s.half_thickness + 0.5) {
        support += mass;
        dense += mass * s.density;
      }
      votes += hit;
      support += hit;
      dense += hit * s.density;
      const double t = d.norm() / std::max(length, s.reach());
      const double of_class = o_.kernel.shape == Kernel::Linear ? std::max(0.0, 1 - t) : kernel(t);
      for (std::size_t k = 1; k < classes.size(); ++k) classes[k] += points_[p].c[k] * of_class;
    }
    if (undecided) undecided_.insert(v);
    const double tau = o_.surface.support;
    const double missing = std::max(0.0, 2 * tau - support);
    const double weight = (0.3 + 0.7 * (1 - missing / (2 * tau))) * std::min(1.0, support / 0.3);
    const double density = support > 0 ? dense / support : 0;
    double all = 0;
    for (const double m : classes) all += m;
    for (double& m : classes) m *= all > 0 ? o_.kernel.scale * weight * votes / all : 0;
    classes[0] = o_.kernel.scale *
                 (weight * o_.surface.counter_evidence * (support - votes + density * missing) +
                  std::max(0.0, 1 - support / tau) * std::min(free, o_.surface.free_limit));
    return classes;
  }

  Options o_;
  std::vector<Point> points_;
  std::vector<Surface> surfaces_;
  std::set<Cell> undecided_;
};

}  // namespace csom::test
