// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/ConfusionMatrix.h>

#include <stdexcept>
#include <string>

namespace csom {
namespace {

double ratio(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

ConfusionMatrix::ConfusionMatrix(int number_of_classes)
    : classes_(number_of_classes),
      counts_(static_cast<std::size_t>(number_of_classes) *
              static_cast<std::size_t>(number_of_classes)) {}

std::size_t ConfusionMatrix::cellOf(ClassId truth, ClassId predicted) const {
  if (truth >= classes_ || predicted >= classes_)
    throw std::out_of_range("class " + std::to_string(truth >= classes_ ? truth : predicted) +
                            " of a confusion matrix of " + std::to_string(classes_) + " classes");
  return static_cast<std::size_t>(truth) * static_cast<std::size_t>(classes_) + predicted;
}

void ConfusionMatrix::add(ClassId truth, ClassId predicted, std::size_t count) {
  counts_[cellOf(truth, predicted)] += count;
  total_ += count;
}

std::size_t ConfusionMatrix::count(ClassId truth, ClassId predicted) const {
  return counts_[cellOf(truth, predicted)];
}

std::size_t ConfusionMatrix::truthCount(ClassId k) const {
  std::size_t sum = 0;
  for (int p = 0; p < classes_; ++p) sum += count(k, static_cast<ClassId>(p));
  return sum;
}

std::size_t ConfusionMatrix::predictedCount(ClassId k) const {
  std::size_t sum = 0;
  for (int t = 0; t < classes_; ++t) sum += count(static_cast<ClassId>(t), k);
  return sum;
}

std::size_t ConfusionMatrix::correct() const {
  std::size_t sum = 0;
  for (int k = 0; k < classes_; ++k) sum += count(static_cast<ClassId>(k), static_cast<ClassId>(k));
  return sum;
}

double ConfusionMatrix::iou(ClassId k) const {
  const std::size_t both = count(k, k);
  return ratio(both, truthCount(k) + predictedCount(k) - both);
}
double ConfusionMatrix::precision(ClassId k) const {
  return ratio(count(k, k), predictedCount(k));
}
double ConfusionMatrix::recall(ClassId k) const {
  return ratio(count(k, k), truthCount(k));
}
double ConfusionMatrix::f1(ClassId k) const {
  return ratio(2 * count(k, k), truthCount(k) + predictedCount(k));
}
double ConfusionMatrix::accuracy() const {
  return ratio(correct(), total_);
}

std::vector<ClassId> ConfusionMatrix::classesInTruth() const {
  std::vector<ClassId> found;
  for (int i = 1; i < classes_; ++i) {
    const auto k = static_cast<ClassId>(i);
    if (truthCount(k) > 0) found.push_back(k);
  }
  return found;
}

double ConfusionMatrix::meanIou() const {
  const std::vector<ClassId> present = classesInTruth();
  double sum = 0;
  for (const ClassId k : present) sum += iou(k);
  return present.empty() ? 0.0 : sum / static_cast<double>(present.size());
}

double ConfusionMatrix::weightedAverageIou() const {
  double sum = 0;
  std::size_t weight = 0;
  for (const ClassId k : classesInTruth()) {
    sum += iou(k) * static_cast<double>(truthCount(k));
    weight += truthCount(k);
  }
  return weight == 0 ? 0.0 : sum / static_cast<double>(weight);
}

double ConfusionMatrix::macroF1() const {
  const std::vector<ClassId> present = classesInTruth();
  double sum = 0;
  for (const ClassId k : present) sum += f1(k);
  return present.empty() ? 0.0 : sum / static_cast<double>(present.size());
}

ConfusionMatrix ConfusionMatrix::occupancy() const {
  ConfusionMatrix binary(2);
  for (int t = 0; t < classes_; ++t) {
    for (int p = 0; p < classes_; ++p)
      binary.add(t > 0 ? 1 : 0, p > 0 ? 1 : 0,
                 count(static_cast<ClassId>(t), static_cast<ClassId>(p)));
  }
  return binary;
}

}  // namespace csom
