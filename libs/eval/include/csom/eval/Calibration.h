// SPDX-License-Identifier: BSD-3-Clause
// Whether probabilities mean what they say.
#pragma once

#include <csom/core/types.h>

#include <array>
#include <cstddef>
#include <vector>

namespace csom {

/// Collects distributions over classes, each with the class that was true.
class Calibration {
 public:
  static constexpr int kBins = 15;

  /// What was said with a confidence in one of kBins equal intervals of [0, 1].
  struct Bin {
    std::size_t count = 0;
    std::size_t correct = 0;
    double confidence_sum = 0;
  };

  /// `probabilities` sum to 1. A class beyond them has probability 0.
  void add(const std::vector<double>& probabilities, ClassId truth);

  std::size_t count() const { return count_; }
  /// Mean of Σ_k (λ^k − [k is true])², between 0 and 2; 0 without samples.
  double brier() const;
  /// Expected calibration error: mean distance between the confidence in the best class (ties: the
  /// lower id) and how often it is right, bin by bin; 0 without samples.
  double expectedCalibrationError() const;
  const std::array<Bin, kBins>& bins() const { return bins_; }

 private:
  std::size_t count_ = 0;
  double brier_sum_ = 0;
  std::array<Bin, kBins> bins_{};
};

}  // namespace csom
