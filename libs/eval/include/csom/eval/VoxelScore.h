// SPDX-License-Identifier: BSD-3-Clause
// How well a map agrees with the truth, voxel by voxel.
#pragma once

#include <csom/core/SemanticMap.h>
#include <csom/eval/ConfusionMatrix.h>

#include <cstddef>
#include <utility>

namespace csom {

/// Agreement of what a map says of voxels with the truth. The class of a voxel is that of an
/// occupied voxel, else 0.
class VoxelScore {
 public:
  explicit VoxelScore(ConfusionMatrix matrix) : matrix_(std::move(matrix)) {}

  /// Agreement of two maps on the same grid, over the box of the truth's known voxels, padded; map
  /// voxels beyond it do not count. Where the truth knows free voxels (a simulated world), voxels
  /// unknown to it are left out; where it does not (a labelled point cloud), they count as class 0.
  /// Throws std::invalid_argument if resolution or number of classes differ, or the truth is empty.
  VoxelScore(const SemanticMap& map, const SemanticMap& truth, double padding = 0.5);

  const ConfusionMatrix& matrix() const { return matrix_; }
  int numberOfClasses() const { return matrix_.numberOfClasses(); }
  /// Voxels with this true class and this class in the map.
  std::size_t confusion(ClassId truth, ClassId predicted) const {
    return matrix_.count(truth, predicted);
  }
  std::size_t truthCount(ClassId k) const { return matrix_.truthCount(k); }
  std::size_t predictedCount(ClassId k) const { return matrix_.predictedCount(k); }
  std::size_t voxels() const { return matrix_.total(); }

  /// Of one class; 0 if neither side has it.
  double iou(ClassId k) const { return matrix_.iou(k); }
  double precision(ClassId k) const { return matrix_.precision(k); }
  double recall(ClassId k) const { return matrix_.recall(k); }
  double f1(ClassId k) const { return matrix_.f1(k); }
  /// Means over the occupied classes of the truth, the first weighted by their number of voxels.
  double weightedAverageIou() const { return matrix_.weightedAverageIou(); }
  double macroF1() const { return matrix_.macroF1(); }

  /// Occupied against not, whatever the class.
  double geometricIou() const { return matrix_.occupancy().iou(1); }
  double geometricPrecision() const { return matrix_.occupancy().precision(1); }
  double geometricRecall() const { return matrix_.occupancy().recall(1); }
  double geometricF1() const { return matrix_.occupancy().f1(1); }
  double freeIou() const { return matrix_.iou(kFreeClass); }

  /// Share of voxels with the right class among those where truth or map is occupied …
  double accuratenessOccupied() const;
  /// … and among all.
  double accuratenessBox() const { return matrix_.accuracy(); }

 private:
  ConfusionMatrix matrix_;
};

}  // namespace csom
