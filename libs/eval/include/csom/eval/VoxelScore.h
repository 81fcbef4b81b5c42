// SPDX-License-Identifier: BSD-3-Clause
// How well a map agrees with the truth, voxel by voxel.
#pragma once

#include <csom/core/SemanticMap.h>

#include <cstddef>
#include <vector>

namespace csom {

/// Agreement of two maps on the same grid.
///
/// The class of a voxel is that of an occupied voxel, else 0. Scores run over the box of the
/// truth's known voxels, padded; map voxels beyond it do not count. Where the truth knows free
/// voxels (a simulated world), voxels unknown to it are left out; where it does not (a labelled
/// point cloud), they count as class 0.
class VoxelScore {
 public:
  /// Throws std::invalid_argument if resolution or number of classes differ, or the truth is empty.
  VoxelScore(const SemanticMap& map, const SemanticMap& truth, double padding = 0.5);

  int numberOfClasses() const { return classes_; }
  /// Voxels with this true class and this class in the map.
  std::size_t confusion(ClassId truth, ClassId predicted) const;
  std::size_t truthCount(ClassId k) const;
  std::size_t predictedCount(ClassId k) const;
  std::size_t voxels() const { return voxels_; }

  /// TP/(TP+FP+FN) of one class; 0 if neither side has it.
  double iou(ClassId k) const;
  double precision(ClassId k) const;
  double recall(ClassId k) const;
  /// Mean of iou() over the occupied classes, weighted by their number of true voxels.
  double weightedAverageIou() const;

  /// Occupied against not, whatever the class.
  double geometricIou() const;
  double geometricPrecision() const;
  double geometricRecall() const;

  /// Share of voxels with the right class among those where truth or map is occupied …
  double accuratenessOccupied() const;
  /// … and among all.
  double accuratenessBox() const;

 private:
  std::size_t& cell(ClassId truth, ClassId predicted);
  std::size_t occupiedInBoth() const;

  int classes_;
  std::size_t voxels_ = 0;
  std::vector<std::size_t> confusion_;  ///< truth × predicted, row-major
};

}  // namespace csom
