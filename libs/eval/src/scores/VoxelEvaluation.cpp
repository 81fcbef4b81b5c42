// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/VoxelEvaluation.h>

#include <utility>

namespace csom {

VoxelEvaluation evaluateVoxels(const Mapper& map, const VoxelTruth& truth) {
  const bool classes = map.hasClasses();
  ConfusionMatrix matrix(classes ? truth.numberOfClasses() : 2);
  VoxelEvaluation evaluation{VoxelScore(ConfusionMatrix(2)), 0, 0, {}, {}, {}};
  ConfusionMatrix known_free(2);  // 1: free, and known to be
  truth.forEach([&](const Eigen::Vector3d& center, ClassId true_class) {
    const VoxelEstimate voxel = map.at(center);
    const bool occupied = true_class != kFreeClass;
    const auto truth_here = classes ? true_class : static_cast<ClassId>(occupied ? 1 : 0);
    const ClassId found = voxel.known ? voxel.class_id : kFreeClass;
    matrix.add(truth_here, classes || found == kFreeClass ? found : static_cast<ClassId>(1));
    if (voxel.known) ++evaluation.known;
    known_free.add(occupied ? 0 : 1, voxel.known && found == kFreeClass ? 1 : 0);
    if (!truth.knowsFree()) return;
    if (!voxel.known) {
      evaluation.occupancy.addUnknown(occupied);
      return;
    }
    evaluation.occupancy.add(voxel.occupancy, occupied);
    evaluation.calibration.add(voxel.probabilities, truth_here);
    evaluation.occupancy_calibration.add({1 - voxel.occupancy, voxel.occupancy}, occupied ? 1 : 0);
  });
  evaluation.score = VoxelScore(std::move(matrix));
  evaluation.known_free_iou = known_free.iou(1);
  return evaluation;
}

}  // namespace csom
