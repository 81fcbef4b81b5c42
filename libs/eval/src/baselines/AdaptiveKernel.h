// SPDX-License-Identifier: BSD-3-Clause
// The kernels of AKIMap: fitted to the samples around each sample.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace csom::detail {

/// A training point of AKIMap, map frame [m].
struct OccupancySample {
  Eigen::Vector3d position;
  bool occupied;
};

struct AdaptiveKernel {
  Eigen::Vector3d center;
  Eigen::Matrix3d axes;     ///< columns: orthonormal
  Eigen::Vector3d lengths;  ///< where the kernel ends along each axis [m]

  /// Distance in which the kernel ends at 1.
  double distance(const Eigen::Vector3d& point) const {
    return (axes.transpose() * (point - center)).cwiseQuotient(lengths).norm();
  }
  /// Half the edges of the kernel's bounding box [m].
  Eigen::Vector3d halfExtent() const {
    return (axes.cwiseAbs2() * lengths.cwiseAbs2()).cwiseSqrt();
  }
  /// 1 / (product of the lengths) [m⁻³].
  double weight() const { return 1 / lengths.prod(); }
};

/// See AkiMapParameters.
struct AdaptiveKernelLimits {
  double resolution;
  double max_search_radius;
  double sensing_range;
  double variance_noise;
};

/// Fits kernels to the samples of one scan.
class AdaptiveKernelFit {
 public:
  /// `samples` must outlive this.
  AdaptiveKernelFit(const std::vector<OccupancySample>& samples, const Eigen::Vector3d& sensor,
                    const AdaptiveKernelLimits& limits);

  AdaptiveKernel kernelOf(std::size_t sample) const;

 private:
  struct Neighbour {
    double distance;  ///< in the kernel's own measure
    bool same_label;
  };

  double searchRadius(const Eigen::Vector3d& position) const;
  std::vector<std::size_t> samplesWithin(const Eigen::Vector3d& center, double radius) const;
  double bestScale(const AdaptiveKernel& kernel, bool occupied,
                   const std::vector<std::size_t>& around) const;
  std::uint64_t cellKey(std::int64_t x, std::int64_t y, std::int64_t z) const;
  std::int64_t cellOf(double coordinate) const;

  const std::vector<OccupancySample>& samples_;
  Eigen::Vector3d sensor_;
  AdaptiveKernelLimits limits_;
  double cell_edge_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells_;
};

}  // namespace csom::detail
