// SPDX-License-Identifier: BSD-3-Clause
// Occupancy by kernels that adapt to the samples around them (AKIMap).
#pragma once

#include <csom/core/Grid.h>
#include <csom/core/Options.h>
#include <csom/eval/Mapper.h>

#include <memory>

namespace csom {

namespace detail {
struct AdaptiveKernel;
struct BetaCounts;
template <class Value>
class SparseVoxels;
}  // namespace detail

/// Defaults as the method's authors published them.
struct AkiMapParameters {
  /// R, how far a sample looks for those that shape its kernel, if sensing_range or more away from
  /// the sensor [m]; at the sensor it is r, and in between it grows linearly. 0 = free_resolution.
  double max_search_radius = 0;
  double sensing_range = 8;  ///< [m]
  /// Added to the variances of a kernel's neighbours [m²]; 0 = theirs, 0.001 m², but at least
  /// 0.1 r²: thinner kernels would miss the centres of voxels that they pass through.
  double variance_noise = 0;
  double prior = 0.001;             ///< α0 = β0, evidence before any scan
  double occupied_threshold = 0.5;  ///< more probable voxels are occupied
};

/// After Y. Kwon, B. Moon, S.-E. Yoon, "Adaptive Kernel Inference for Dense and Sharp Occupancy
/// Grids", IEEE/RSJ IROS 2020; constants and corner cases are those of the program that its
/// authors published.
///
/// Hits and free samples each have an anisotropic sparse kernel. Its axes and lengths are those of
/// the covariance, about the sample, of the samples with the same label within a search radius:
/// long within a surface, thin across it. Where samples of the other label lie inside, the kernel
/// shrinks: of the scales s between 1 and that at which its longest axis is r, it takes the one of
/// the least
///
///     s⁻³ Σ_j (t_j − k(d_j/s))²
///
/// over the samples j inside the kernel at s = 1, at distances d_j; t_j = k(d_j) for samples of
/// its own label and 0 for others. A sample with fewer than two neighbours of its label has an
/// isotropic kernel of length r. Each kernel is weighted by the inverse of its volume; α and β are
/// sums of the kernels of hits and of free samples.
///
/// Decided here: of 33 scales in equal ratios the largest of least cost is taken, where the
/// authors' program makes steps of gradient descent, whose length their weights, which vary by
/// orders of magnitude, would decide; free samples lie at regular steps before each hit and not at
/// random ones, so that the same input gives the same map; and variance_noise has a least
/// value. As in that program there is one sample a voxel, the sensor's place is one of the
/// free ones, and none is free where there is a hit.
class AkiMapMapper : public Mapper {
 public:
  /// Of `input`: resolution, ranges, ds_resolution, number_of_classes and free_resolution; with
  /// free_space none there are no free samples, otherwise they are sampled. Throws OptionError.
  explicit AkiMapMapper(const Options& input, const AkiMapParameters& parameters = {});
  ~AkiMapMapper() override;

  /// Besides, throws std::invalid_argument for soft labels.
  void insert(const Scan& scan) override;
  VoxelEstimate at(const Eigen::Vector3d& center) const override;
  bool hasClasses() const override { return false; }

 private:
  void add(const detail::AdaptiveKernel& kernel, double detail::BetaCounts::*count);

  Options input_;
  AkiMapParameters parameters_;
  Grid grid_;
  std::unique_ptr<detail::SparseVoxels<detail::BetaCounts>> voxels_;
};

}  // namespace csom
