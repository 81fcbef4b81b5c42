// SPDX-License-Identifier: BSD-3-Clause
// Occupancy by Gaussian processes of blocks, fused by Bayesian committee machines (GPOctoMap).
#pragma once

#include <csom/core/Grid.h>
#include <csom/core/Options.h>
#include <csom/eval/Mapper.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace csom {

namespace detail {
struct FusedGaussian;
template <class Value>
class SparseVoxels;
}  // namespace detail

/// Defaults as in the configuration that the method's authors published.
struct GpOctoMapParameters {
  double kernel_length = 1;          ///< ℓ of the Matérn kernel with ν = 3/2 [m]
  double signal_variance = 1;        ///< σ_f², the kernel's value at distance 0
  double noise_variance = 0.01;      ///< σ_n² of the labels
  int block_depth = 3;               ///< a block is 2^(block_depth−1) voxels a side; 1 … 4
  double logistic_slope = 100;       ///< γ
  double min_variance = 0.001;       ///< σ_min²
  double max_known_variance = 0.02;  ///< voxels of more are unknown
  double occupied_threshold = 0.7;   ///< more probable voxels are occupied
};

/// After J. Wang, B. Englot, "Fast, Accurate Gaussian Process Occupancy Maps via Test-Data
/// Octrees and Nested Bayesian Fusion", IEEE ICRA 2016.
///
/// Hits are training points with y = 1, free samples with y = −1. The points of each block train a
/// Gaussian process, which predicts mean and variance at the voxels of its block and of the six
/// that share a face with it. A voxel fuses the predictions of the blocks around it, and those of
/// all scans, as a Bayesian committee machine:
///
///     1/σ² = 1/σ_f² + Σ (1/σ_i² − 1/σ_f²),    μ/σ² = Σ μ_i/σ_i²
///
/// Its occupancy is the logistic function of γ·σ_min²·μ/σ².
///
/// All voxels of a block are predicted; the paper's octree within a block, which only merges voxels
/// that came out alike, is left out. What bounds the size of a Gaussian process is the density of
/// its input, as in the paper: set ds_resolution for dense clouds.
class GpOctoMapMapper : public Mapper {
 public:
  /// Of `input`: resolution, ranges, ds_resolution, number_of_classes and free_resolution; with
  /// free_space none there are no free samples, otherwise they are sampled. Throws OptionError.
  explicit GpOctoMapMapper(const Options& input, const GpOctoMapParameters& parameters = {});
  ~GpOctoMapMapper() override;

  /// Besides, throws std::invalid_argument for soft labels.
  void insert(const Scan& scan) override;
  VoxelEstimate at(const Eigen::Vector3d& center) const override;
  bool hasClasses() const override { return false; }

 private:
  struct BlockPoints;

  void fusePredictionsOf(const BlockIndex& block, const BlockPoints& training);
  std::vector<VoxelIndex> predictedBy(const BlockIndex& block) const;
  double covariance(double distance) const;

  Options input_;
  GpOctoMapParameters parameters_;
  Grid grid_;
  std::unique_ptr<detail::SparseVoxels<detail::FusedGaussian>> voxels_;
};

}  // namespace csom
