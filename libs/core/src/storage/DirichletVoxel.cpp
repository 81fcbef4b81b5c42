// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/DirichletVoxel.h>

#include <algorithm>

namespace csom {

const char* toString(VoxelState state) {
  switch (state) {
    case VoxelState::Unknown:
      return "unknown";
    case VoxelState::Free:
      return "free";
    case VoxelState::Occupied:
      return "occupied";
  }
  return "invalid";
}

ClassId DirichletVoxel::mostLikelyClass() const {
  if (!known()) return kFreeClass;
  if (unlabelled_ != 0) return mostLikelyLabel();
  return classes_[std::max_element(counts_, counts_ + size_) - counts_];
}

ClassId DirichletVoxel::surfaceClass() const {
  std::uint64_t best_count = 0;
  ClassId best = unlabelled_ != 0 && count(unlabelled_) > 0 ? unlabelled_ : kFreeClass;
  for (int i = 0; i < size_; ++i) {
    if (classes_[i] == kFreeClass || classes_[i] == unlabelled_ || counts_[i] <= best_count)
      continue;
    best_count = counts_[i];
    best = classes_[i];
  }
  return best;
}

ClassId DirichletVoxel::mostLikelyLabel() const {
  const ClassId best = surfaceClass();
  const std::uint64_t labelled = best == kFreeClass || best == unlabelled_ ? 0 : count(best);
  return count(kFreeClass) >= labelled + count(unlabelled_) ? kFreeClass : best;
}

std::uint32_t DirichletVoxel::count(ClassId k) const {
  const auto* const end = classes_ + size_;
  const auto* const found = std::lower_bound(classes_, end, k);
  return found != end && *found == k ? counts_[found - classes_] : 0;
}

double DirichletVoxel::evidence() const {
  std::uint64_t sum = 0;
  for (int i = 0; i < size_; ++i) sum += counts_[i];
  return kCountQuantum * static_cast<double>(sum);
}

double DirichletVoxel::probability(ClassId k) const {
  if (k >= number_of_classes_) return 0;
  return (prior_ + evidence(k)) / (number_of_classes_ * prior_ + evidence());
}

std::vector<double> DirichletVoxel::probabilities() const {
  const double total = number_of_classes_ * prior_ + evidence();
  std::vector<double> lambda(static_cast<std::size_t>(number_of_classes_), prior_ / total);
  for (int i = 0; i < size_; ++i)
    lambda[classes_[i]] = (prior_ + kCountQuantum * counts_[i]) / total;
  return lambda;
}

double DirichletVoxel::variance(ClassId k) const {
  const double lambda = probability(k);
  return lambda * (1 - lambda) / (evidence() + number_of_classes_ * prior_ + 1);
}

double DirichletVoxel::entropy() const {
  const auto term = [](double lambda) { return lambda > 0 ? -lambda * std::log(lambda) : 0.0; };
  const double total = number_of_classes_ * prior_ + evidence();
  double sum = (number_of_classes_ - size_) * term(prior_ / total);
  for (int i = 0; i < size_; ++i) sum += term((prior_ + kCountQuantum * counts_[i]) / total);
  return sum / std::log(number_of_classes_);
}

}  // namespace csom
