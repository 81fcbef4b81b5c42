// SPDX-License-Identifier: BSD-3-Clause
// A map that says of each voxel what a test tells it to.
#pragma once

#include <csom/core/Grid.h>
#include <csom/eval/Mapper.h>

#include <map>
#include <vector>

namespace csom::test {

class FakeMapper : public Mapper {
 public:
  FakeMapper(double resolution, bool classes) : grid_(resolution), classes_(classes) {}

  /// λ of each class, free first; the most probable one is the voxel's class.
  void set(const VoxelIndex& voxel, const std::vector<double>& probabilities) {
    VoxelEstimate& estimate = voxels_[voxel];
    estimate.known = true;
    estimate.occupancy = 1 - probabilities[0];
    estimate.probabilities = probabilities;
    estimate.class_id = 0;
    for (std::size_t k = 1; k < probabilities.size(); ++k)
      if (probabilities[k] > probabilities[estimate.class_id])
        estimate.class_id = static_cast<ClassId>(k);
  }

  void insert(const Scan&) override {}
  VoxelEstimate at(const Eigen::Vector3d& center) const override {
    const auto found = voxels_.find(grid_.voxelAt(center));
    return found == voxels_.end() ? VoxelEstimate{} : found->second;
  }
  bool hasClasses() const override { return classes_; }

 private:
  Grid grid_;
  bool classes_;
  std::map<VoxelIndex, VoxelEstimate> voxels_;
};

}  // namespace csom::test
