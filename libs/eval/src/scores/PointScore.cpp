// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/PointScore.h>

namespace csom {

PointScore::PointScore(int number_of_classes)
    : all_(number_of_classes), covered_(number_of_classes), occupied_(number_of_classes) {}

void PointScore::add(ClassId truth, const VoxelEstimate& voxel) {
  if (!voxel.known) {
    all_.add(truth, kFreeClass);
    occupied_.add(truth, kFreeClass);
    return;
  }
  all_.add(truth, voxel.surface_class);
  covered_.add(truth, voxel.surface_class);
  occupied_.add(truth, voxel.class_id);
  calibration_.add(voxel.probabilities, truth);
}

void PointScore::add(ClassId truth, ClassId predicted) {
  all_.add(truth, predicted);
  covered_.add(truth, predicted);
  occupied_.add(truth, predicted);
}

double PointScore::coverage() const {
  return all_.total() == 0
             ? 0.0
             : static_cast<double>(covered_.total()) / static_cast<double>(all_.total());
}

}  // namespace csom
