// SPDX-License-Identifier: BSD-3-Clause
// How well a map names the points of a labelled cloud.
#pragma once

#include <csom/eval/Calibration.h>
#include <csom/eval/ConfusionMatrix.h>
#include <csom/eval/Mapper.h>

#include <cstddef>

namespace csom {

/// What the voxel at each labelled point says of it. A labelled point lies on a surface, so that
/// its truth is compared with the class that a surface in the voxel would have. An unknown voxel
/// gives the point class 0, which is never right: points never seen count, or a map could do better
/// by knowing less. The scores named `covered` are over the points in known voxels alone; to those
/// named `occupied` a point is wrong too if the map holds its voxel to be free.
class PointScore {
 public:
  explicit PointScore(int number_of_classes);

  void add(ClassId truth, const VoxelEstimate& voxel);
  /// A label that comes without a map; probabilities are not scored.
  void add(ClassId truth, ClassId predicted);

  std::size_t points() const { return all_.total(); }
  const ConfusionMatrix& matrix() const { return all_; }
  /// Mean IoU over the classes present in the truth.
  double meanIou() const { return all_.meanIou(); }
  double accuracy() const { return all_.accuracy(); }
  double occupiedMeanIou() const { return occupied_.meanIou(); }
  double occupiedAccuracy() const { return occupied_.accuracy(); }
  double coveredMeanIou() const { return covered_.meanIou(); }
  double coveredAccuracy() const { return covered_.accuracy(); }
  /// Share of points in a known voxel.
  double coverage() const;
  /// Of λ, over the points in known voxels.
  const Calibration& calibration() const { return calibration_; }

 private:
  ConfusionMatrix all_;
  ConfusionMatrix covered_;
  ConfusionMatrix occupied_;
  Calibration calibration_;
};

}  // namespace csom
