// SPDX-License-Identifier: BSD-3-Clause
// Occupancy by Bayesian generalised kernel inference with free space as line segments
// (BGKOctoMap-L).
#pragma once

#include <csom/core/Grid.h>
#include <csom/core/Options.h>
#include <csom/eval/Mapper.h>

#include <memory>

namespace csom {

namespace detail {
struct BetaCounts;
template <class Value>
class SparseVoxels;
}  // namespace detail

/// Defaults as in the configuration that the method's authors published.
struct BgkOctoMapParameters {
  double kernel_length = 0;         ///< l [m]; 0 = 2 r: theirs is 0.2 m at r = 0.1 m
  double kernel_scale = 1;          ///< σ0, the kernel's value at distance 0
  double prior = 0.001;             ///< α0 = β0, evidence before any scan
  double occupied_threshold = 0.7;  ///< more probable voxels are occupied
};

/// After K. Doherty, T. Shan, J. Wang, B. Englot, "Learning-Aided 3-D Occupancy Mapping With
/// Bayesian Generalized Kernel Inference", IEEE Transactions on Robotics 35(4), 2019.
///
/// A hit is a training point with y = 1. Each beam is one with y = 0: the segment from the sensor
/// to `free_resolution` before the hit, at the distance of whichever of its points is nearest to
/// the voxel. With the sparse kernel k of Melkumyan and Ramos every scan adds Σ k·y to α and Σ
/// k·(1−y) to β of a voxel, whose occupancy is (α0+α)/(α0+α+β0+β).
///
/// The authors' program cuts segments and neighbourhoods at blocks and counts a segment again in
/// each block around; here every training point within l counts once, which is the paper's sum.
/// Points given as free count as segments of length 0.
class BgkOctoMapMapper : public Mapper {
 public:
  /// Of `input`: resolution, ranges, ds_resolution, number_of_classes and free_resolution; with
  /// free_space none there are no beams, and any other value means segments. Throws OptionError.
  explicit BgkOctoMapMapper(const Options& input, const BgkOctoMapParameters& parameters = {});
  ~BgkOctoMapMapper() override;

  /// Besides, throws std::invalid_argument for soft labels.
  void insert(const Scan& scan) override;
  VoxelEstimate at(const Eigen::Vector3d& center) const override;
  bool hasClasses() const override { return false; }

 private:
  void addSegment(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                  double detail::BetaCounts::*count);

  Options input_;
  BgkOctoMapParameters parameters_;
  Grid grid_;
  std::unique_ptr<detail::SparseVoxels<detail::BetaCounts>> voxels_;
};

}  // namespace csom
