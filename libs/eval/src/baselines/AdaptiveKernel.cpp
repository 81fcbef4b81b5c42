// SPDX-License-Identifier: BSD-3-Clause
#include "baselines/AdaptiveKernel.h"

#include <csom/core/Kernel.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace csom::detail {
namespace {

double kernelAt(double distance) {
  return distance < 1 ? static_cast<double>(sparseKernel(static_cast<float>(distance))) : 0;
}

/// Of some scales from 1 down to `min` the largest of least cost. Costs that differ by less than
/// what single precision leaves of them count as equal.
template <class Cost>
double scaleOfLeastCost(double min, Cost&& cost) {
  constexpr int kSteps = 32;
  constexpr double kTolerance = 1e-6;
  double best = 1;
  double least = cost(1.0);
  for (int i = 1; i <= kSteps; ++i) {
    const double scale = std::pow(min, static_cast<double>(i) / kSteps);
    const double here = cost(scale);
    if (here >= least - kTolerance) continue;
    best = scale;
    least = here;
  }
  return best;
}

}  // namespace

AdaptiveKernelFit::AdaptiveKernelFit(const std::vector<OccupancySample>& samples,
                                     const Eigen::Vector3d& sensor,
                                     const AdaptiveKernelLimits& limits)
    : samples_(samples),
      sensor_(sensor),
      limits_(limits),
      cell_edge_(limits.max_search_radius / 2) {
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const Eigen::Vector3d& p = samples_[i].position;
    cells_[cellKey(cellOf(p.x()), cellOf(p.y()), cellOf(p.z()))].push_back(i);
  }
}

AdaptiveKernel AdaptiveKernelFit::kernelOf(std::size_t sample) const {
  const OccupancySample& own = samples_[sample];
  const std::vector<std::size_t> around = samplesWithin(own.position, searchRadius(own.position));
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  int alike = 0;  // itself included
  for (const std::size_t i : around) {
    if (samples_[i].occupied != own.occupied) continue;
    const Eigen::Vector3d offset = samples_[i].position - own.position;
    scatter += offset * offset.transpose();
    ++alike;
  }
  if (alike <= 2)
    return {own.position, Eigen::Matrix3d::Identity(),
            Eigen::Vector3d::Constant(limits_.resolution)};

  const Eigen::Matrix3d covariance =
      scatter / (alike - 2) + limits_.variance_noise * Eigen::Matrix3d::Identity();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  AdaptiveKernel kernel{own.position, eigen.eigenvectors(), eigen.eigenvalues().cwiseSqrt()};
  kernel.lengths *= bestScale(kernel, own.occupied, around);
  return kernel;
}

double AdaptiveKernelFit::bestScale(const AdaptiveKernel& kernel, bool occupied,
                                    const std::vector<std::size_t>& around) const {
  std::vector<Neighbour> inside;
  bool contested = false;
  for (const std::size_t i : around) {
    const double distance = kernel.distance(samples_[i].position);
    if (distance >= 1) continue;
    inside.push_back({distance, samples_[i].occupied == occupied});
    contested = contested || !inside.back().same_label;
  }
  const double min_scale = limits_.resolution / kernel.lengths.maxCoeff();
  if (!contested || min_scale >= 1) return 1;
  return scaleOfLeastCost(min_scale, [&](double scale) {
    double squares = 0;
    for (const Neighbour& neighbour : inside) {
      const double target = neighbour.same_label ? kernelAt(neighbour.distance) : 0;
      const double error = target - kernelAt(neighbour.distance / scale);
      squares += error * error;
    }
    return squares / (scale * scale * scale);
  });
}

double AdaptiveKernelFit::searchRadius(const Eigen::Vector3d& position) const {
  const double share = std::min((position - sensor_).norm() / limits_.sensing_range, 1.0);
  return limits_.resolution + share * (limits_.max_search_radius - limits_.resolution);
}

std::vector<std::size_t> AdaptiveKernelFit::samplesWithin(const Eigen::Vector3d& center,
                                                          double radius) const {
  std::vector<std::size_t> found;
  for (std::int64_t z = cellOf(center.z() - radius); z <= cellOf(center.z() + radius); ++z)
    for (std::int64_t y = cellOf(center.y() - radius); y <= cellOf(center.y() + radius); ++y)
      for (std::int64_t x = cellOf(center.x() - radius); x <= cellOf(center.x() + radius); ++x) {
        const auto cell = cells_.find(cellKey(x, y, z));
        if (cell == cells_.end()) continue;
        for (const std::size_t i : cell->second)
          if ((samples_[i].position - center).squaredNorm() <= radius * radius) found.push_back(i);
      }
  return found;
}

std::int64_t AdaptiveKernelFit::cellOf(double coordinate) const {
  return static_cast<std::int64_t>(std::floor(coordinate / cell_edge_));
}

/// Cells 2²¹ apart share a key; distances tell their samples apart.
std::uint64_t AdaptiveKernelFit::cellKey(std::int64_t x, std::int64_t y, std::int64_t z) const {
  const auto bits = [](std::int64_t i) { return static_cast<std::uint64_t>(i) & 0x1fffff; };
  return bits(x) | bits(y) << 21 | bits(z) << 42;
}

}  // namespace csom::detail
