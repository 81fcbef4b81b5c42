// SPDX-License-Identifier: BSD-3-Clause
// All scores that look at voxels, in one pass over the truth.
#pragma once

#include <csom/eval/Calibration.h>
#include <csom/eval/Mapper.h>
#include <csom/eval/RocCurve.h>
#include <csom/eval/VoxelScore.h>
#include <csom/eval/VoxelTruth.h>

namespace csom {

struct VoxelEvaluation {
  /// Classes of the truth; free and occupied alone for a mapper without classes.
  VoxelScore score;
  std::size_t known = 0;  ///< voxels of the truth that the map knows
  /// TP/(TP+FP+FN) of the voxels that the map knows to be free: score.freeIou() counts the unknown
  /// among them.
  double known_free_iou = 0;
  // Only where the truth knows free voxels:
  RocSamples occupancy;               ///< probability that a voxel is occupied
  Calibration calibration;            ///< of λ, over the known voxels
  Calibration occupancy_calibration;  ///< of (free, occupied), over the known voxels
};

VoxelEvaluation evaluateVoxels(const Mapper& map, const VoxelTruth& truth);

}  // namespace csom
