// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/Calibration.h>

#include <algorithm>
#include <cmath>

namespace csom {

void Calibration::add(const std::vector<double>& probabilities, ClassId truth) {
  double distance = truth < probabilities.size() ? 0.0 : 1.0;
  std::size_t best = 0;
  for (std::size_t k = 0; k < probabilities.size(); ++k) {
    const double error = probabilities[k] - (k == truth ? 1.0 : 0.0);
    distance += error * error;
    if (probabilities[k] > probabilities[best]) best = k;
  }
  ++count_;
  brier_sum_ += distance;
  const double confidence = probabilities.empty() ? 0.0 : probabilities[best];
  const int bin = std::clamp(static_cast<int>(confidence * kBins), 0, kBins - 1);
  Bin& chosen = bins_[static_cast<std::size_t>(bin)];
  ++chosen.count;
  chosen.confidence_sum += confidence;
  if (!probabilities.empty() && best == truth) ++chosen.correct;
}

double Calibration::brier() const {
  return count_ == 0 ? 0.0 : brier_sum_ / static_cast<double>(count_);
}

double Calibration::expectedCalibrationError() const {
  double sum = 0;
  for (const Bin& bin : bins_)
    sum += std::abs(static_cast<double>(bin.correct) - bin.confidence_sum);
  return count_ == 0 ? 0.0 : sum / static_cast<double>(count_);
}

}  // namespace csom
