// SPDX-License-Identifier: BSD-3-Clause
// Occupancy by OctoMap.
#pragma once

#include <csom/core/Options.h>
#include <csom/eval/Mapper.h>

#include <memory>

namespace octomap {
class OcTree;
}

namespace csom {

/// OctoMap's own defaults.
struct OctoMapParameters {
  double hit_probability = 0.7;
  double miss_probability = 0.4;
  double clamping_min = 0.1192;  ///< a voxel's probability never leaves these bounds
  double clamping_max = 0.971;
  double occupied_threshold = 0.5;  ///< more probable voxels are occupied
};

/// liboctomap: A. Hornung, K. M. Wurm, M. Bennewitz, C. Stachniss, W. Burgard, "OctoMap: An
/// Efficient Probabilistic 3D Mapping Framework Based on Octrees", Autonomous Robots 34(3), 2013.
/// Beams are discretised: a scan updates a voxel once, and a hit in it outweighs what crosses it.
/// Points given as free are a miss of their voxel.
class OctoMapMapper : public Mapper {
 public:
  /// Of `input`: resolution, ranges, ds_resolution and number_of_classes; with free_space none no
  /// voxel is ever missed, and any other value means beams. Throws OptionError.
  explicit OctoMapMapper(const Options& input, const OctoMapParameters& parameters = {});
  ~OctoMapMapper() override;

  /// Besides, throws std::invalid_argument for soft labels, and for what lies beyond the 32768
  /// voxels from the map's origin that OctoMap reaches along each axis.
  void insert(const Scan& scan) override;
  VoxelEstimate at(const Eigen::Vector3d& center) const override;
  bool hasClasses() const override { return false; }

 private:
  Options input_;
  OctoMapParameters parameters_;
  std::unique_ptr<octomap::OcTree> tree_;
};

}  // namespace csom
