// SPDX-License-Identifier: BSD-3-Clause
// A voxel's Dirichlet counts, and what follows from them (eq. 22).
#pragma once

#include <csom/core/types.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace csom {

/// Counts are integers in units of 2⁻¹²: integer addition commutes, which makes maps independent of
/// the order of scans, the number of threads and the split into shards.
constexpr double kCountQuantum = 1.0 / 4096.0;
constexpr std::uint32_t kMaxCount = 0xffffffffu;

/// Saturating sum: still commutative and associative.
inline std::uint32_t addCounts(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t sum = a + b;
  return sum < a ? kMaxCount : sum;
}

/// A voxel without any count is Unknown; otherwise Free if class 0 has the most evidence, else
/// Occupied.
enum class VoxelState : std::uint8_t { Unknown, Free, Occupied };
const char* toString(VoxelState state);

/// Read-only view of one voxel of a map. Valid until the map is modified or destroyed. All
/// probabilities are the posterior means λ^k = (σ0+σ^k)/(K·σ0+Σσ) (eq. 22).
class DirichletVoxel {
 public:
  /// `unlabelled`: see Options::unlabelled_class_id; 0 = none.
  DirichletVoxel(int number_of_classes, double prior, ClassId unlabelled)
      : number_of_classes_(number_of_classes), unlabelled_(unlabelled), prior_(prior) {}
  DirichletVoxel(int number_of_classes, double prior, ClassId unlabelled,
                 const std::uint8_t* classes, const std::uint32_t* counts, int size)
      : classes_(classes),
        counts_(counts),
        size_(size),
        number_of_classes_(number_of_classes),
        unlabelled_(unlabelled),
        prior_(prior) {}

  /// True if any class has a count.
  bool known() const { return size_ > 0; }
  VoxelState state() const {
    if (!known()) return VoxelState::Unknown;
    // Nearly always so: there is no evidence of free, or of nothing else.
    if (classes_[0] != kFreeClass) return VoxelState::Occupied;
    if (size_ == 1) return VoxelState::Free;
    return mostLikelyClass() == kFreeClass ? VoxelState::Free : VoxelState::Occupied;
  }
  /// The class of highest probability (ties: the lower id); kFreeClass if unknown. Where points
  /// without a label are a class of their own, their evidence counts for the best other occupied
  /// class, so that this one is returned although its own probability may be lower.
  ClassId mostLikelyClass() const;
  /// The most likely class of a surface, should there be one in the voxel: of the occupied classes
  /// that with the most evidence, even where the voxel is held to be free. kFreeClass if no
  /// occupied class has any.
  ClassId surfaceClass() const;

  /// λ^k of one class; 1/K everywhere in an unknown voxel.
  double probability(ClassId k) const;
  /// All K of them; they sum to 1.
  std::vector<double> probabilities() const;
  /// 1 − λ^0.
  double occupancy() const { return 1.0 - probability(kFreeClass); }
  /// λ^k(1−λ^k)/(Σσ+K·σ0+1), the variance of the Dirichlet marginal.
  double variance(ClassId k) const;
  /// −Σ λ ln λ / ln K, in [0, 1].
  double entropy() const;

  /// σ^k, kernel mass of one class so far.
  double evidence(ClassId k) const { return kCountQuantum * count(k); }
  /// Σσ over the classes.
  double evidence() const;

  /// Raw storage: the classes seen (ascending) and their counts in quanta.
  int size() const { return size_; }
  ClassId classAt(int i) const { return classes_[i]; }
  std::uint32_t countAt(int i) const { return counts_[i]; }
  /// Count of one class in quanta; 0 if never seen.
  std::uint32_t count(ClassId k) const;

  int numberOfClasses() const { return number_of_classes_; }

 private:
  ClassId mostLikelyLabel() const;

  const std::uint8_t* classes_ = nullptr;
  const std::uint32_t* counts_ = nullptr;
  int size_ = 0;
  int number_of_classes_;
  ClassId unlabelled_ = 0;
  double prior_;
};

}  // namespace csom
