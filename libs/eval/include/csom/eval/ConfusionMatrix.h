// SPDX-License-Identifier: BSD-3-Clause
// How often each class was taken for each other, and what follows from it.
#pragma once

#include <csom/core/types.h>

#include <cstddef>
#include <vector>

namespace csom {

/// Counts of (true class, predicted class). Class 0 is free. Ratios whose denominator is 0 are 0.
class ConfusionMatrix {
 public:
  explicit ConfusionMatrix(int number_of_classes);

  /// Throws std::out_of_range for a class that the matrix does not have.
  void add(ClassId truth, ClassId predicted, std::size_t count = 1);

  int numberOfClasses() const { return classes_; }
  std::size_t count(ClassId truth, ClassId predicted) const;
  std::size_t truthCount(ClassId k) const;
  std::size_t predictedCount(ClassId k) const;
  std::size_t total() const { return total_; }
  /// On the diagonal.
  std::size_t correct() const;

  /// TP/(TP+FP+FN), TP/(TP+FP), TP/(TP+FN) and 2TP/(2TP+FP+FN) of one class.
  double iou(ClassId k) const;
  double precision(ClassId k) const;
  double recall(ClassId k) const;
  double f1(ClassId k) const;
  /// correct()/total().
  double accuracy() const;

  /// Occupied classes that the truth has, ascending.
  std::vector<ClassId> classesInTruth() const;
  /// Over classesInTruth(): mean, and mean weighted by the number of true ones.
  double meanIou() const;
  double weightedAverageIou() const;
  double macroF1() const;

  /// The same counts of occupied (1) and free (0), whatever the class.
  ConfusionMatrix occupancy() const;

 private:
  std::size_t cellOf(ClassId truth, ClassId predicted) const;

  int classes_;
  std::size_t total_ = 0;
  std::vector<std::size_t> counts_;  ///< truth × predicted, row-major
};

}  // namespace csom
