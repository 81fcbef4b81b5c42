// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/VoxelScore.h>

#include <cmath>
#include <stdexcept>

namespace csom {

namespace {

ClassId classOf(const DirichletVoxel& voxel) {
  return voxel.state() == VoxelState::Occupied ? voxel.mostLikelyClass() : kFreeClass;
}

double ratio(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

VoxelBox padded(VoxelBox box, std::int32_t margin) {
  box.min = {box.min.x - margin, box.min.y - margin, box.min.z - margin};
  box.max = {box.max.x + margin, box.max.y + margin, box.max.z + margin};
  return box;
}

std::size_t volume(const VoxelBox& box) {
  const auto edge = [](std::int32_t min, std::int32_t max) {
    return static_cast<std::size_t>(static_cast<std::int64_t>(max) - min + 1);
  };
  return edge(box.min.x, box.max.x) * edge(box.min.y, box.max.y) * edge(box.min.z, box.max.z);
}

}  // namespace

VoxelScore::VoxelScore(const SemanticMap& map, const SemanticMap& truth, double padding)
    : classes_(truth.options().number_of_classes),
      confusion_(static_cast<std::size_t>(classes_) * static_cast<std::size_t>(classes_)) {
  if (map.options().resolution != truth.options().resolution ||
      map.options().number_of_classes != truth.options().number_of_classes)
    throw std::invalid_argument("map and truth cannot be compared: resolution " +
                                toString(map.options().resolution) + " against " +
                                toString(truth.options().resolution) + " m, " +
                                toString(map.options().number_of_classes) + " against " +
                                toString(truth.options().number_of_classes) + " classes");
  const auto known = truth.boundingBox();
  if (!known) throw std::invalid_argument("the truth is empty");
  const VoxelBox box =
      padded(*known, static_cast<std::int32_t>(std::ceil(padding / truth.grid().resolution())));

  std::size_t free_voxels = 0;
  std::size_t known_voxels = 0;
  truth.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
    ++known_voxels;
    if (voxel.state() == VoxelState::Free) ++free_voxels;
    ++cell(classOf(voxel), classOf(map.voxel(v)));
  });
  if (free_voxels > 0) {
    voxels_ = known_voxels;
    return;
  }
  map.forEachVoxelInBox(box, [&](const VoxelIndex& v, const DirichletVoxel& voxel) {
    if (voxel.state() == VoxelState::Occupied && !truth.voxel(v).known())
      ++cell(kFreeClass, voxel.mostLikelyClass());
  });
  voxels_ = volume(box);
  std::size_t listed = 0;
  for (const std::size_t count : confusion_) listed += count;
  cell(kFreeClass, kFreeClass) += voxels_ - listed;
}

std::size_t& VoxelScore::cell(ClassId truth, ClassId predicted) {
  return confusion_[static_cast<std::size_t>(truth) * static_cast<std::size_t>(classes_) +
                    predicted];
}

std::size_t VoxelScore::confusion(ClassId truth, ClassId predicted) const {
  return confusion_[static_cast<std::size_t>(truth) * static_cast<std::size_t>(classes_) +
                    predicted];
}

std::size_t VoxelScore::truthCount(ClassId k) const {
  std::size_t sum = 0;
  for (int p = 0; p < classes_; ++p) sum += confusion(k, static_cast<ClassId>(p));
  return sum;
}

std::size_t VoxelScore::predictedCount(ClassId k) const {
  std::size_t sum = 0;
  for (int t = 0; t < classes_; ++t) sum += confusion(static_cast<ClassId>(t), k);
  return sum;
}

double VoxelScore::iou(ClassId k) const {
  const std::size_t both = confusion(k, k);
  return ratio(both, truthCount(k) + predictedCount(k) - both);
}
double VoxelScore::precision(ClassId k) const {
  return ratio(confusion(k, k), predictedCount(k));
}
double VoxelScore::recall(ClassId k) const {
  return ratio(confusion(k, k), truthCount(k));
}

double VoxelScore::weightedAverageIou() const {
  double sum = 0;
  std::size_t weight = 0;
  for (int i = 1; i < classes_; ++i) {
    const auto k = static_cast<ClassId>(i);
    sum += iou(k) * static_cast<double>(truthCount(k));
    weight += truthCount(k);
  }
  return weight == 0 ? 0.0 : sum / static_cast<double>(weight);
}

std::size_t VoxelScore::occupiedInBoth() const {
  return voxels_ - truthCount(kFreeClass) - predictedCount(kFreeClass) +
         confusion(kFreeClass, kFreeClass);
}
double VoxelScore::geometricIou() const {
  return ratio(occupiedInBoth(), voxels_ - confusion(kFreeClass, kFreeClass));
}
double VoxelScore::geometricPrecision() const {
  return ratio(occupiedInBoth(), voxels_ - predictedCount(kFreeClass));
}
double VoxelScore::geometricRecall() const {
  return ratio(occupiedInBoth(), voxels_ - truthCount(kFreeClass));
}

double VoxelScore::accuratenessOccupied() const {
  std::size_t right = 0;
  for (int k = 1; k < classes_; ++k)
    right += confusion(static_cast<ClassId>(k), static_cast<ClassId>(k));
  return ratio(right, voxels_ - confusion(kFreeClass, kFreeClass));
}
double VoxelScore::accuratenessBox() const {
  std::size_t right = 0;
  for (int k = 0; k < classes_; ++k)
    right += confusion(static_cast<ClassId>(k), static_cast<ClassId>(k));
  return ratio(right, voxels_);
}

}  // namespace csom
