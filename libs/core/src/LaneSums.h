// SPDX-License-Identifier: BSD-3-Clause
// Sums of kernel mass by class for eight voxels at a time.
#pragma once

#include <csom/core/types.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace csom::detail {

/// SIMD lanes are voxels: each lane adds its points one after the other, so that the sum does not
/// depend on the width of the processor's vectors.
constexpr std::size_t kLanes = 8;
using Lanes = std::array<float, kLanes>;

/// Class sums of the voxels of eight lanes. Single precision, carried over to double precision
/// every kCarryInterval points, so that a million points at one place still sum up right.
class LaneSums {
 public:
  explicit LaneSums(int number_of_classes)
      : sums_(static_cast<std::size_t>(number_of_classes)),
        carried_(static_cast<std::size_t>(number_of_classes)),
        touched_flag_(static_cast<std::size_t>(number_of_classes), false) {}

  void reset() {
    for (const ClassId k : touched_) {
      sums_[k].fill(0.0F);
      carried_[k].fill(0.0);
      touched_flag_[k] = false;
    }
    touched_.clear();
    added_ = 0;
  }

  void add(ClassId k, const Lanes& mass) {
    touch(k);
    for (std::size_t lane = 0; lane < kLanes; ++lane) sums_[k][lane] += mass[lane];
    countAddition();
  }

  /// One point with a class vector of `sums_.size()` scores.
  void add(const float* scores, const Lanes& mass) {
    for (std::size_t k = 0; k < sums_.size(); ++k) {
      const float score = scores[k];
      if (score <= 0) continue;
      touch(static_cast<ClassId>(k));
      for (std::size_t lane = 0; lane < kLanes; ++lane) sums_[k][lane] += mass[lane] * score;
    }
    countAddition();
  }

  bool empty() const { return touched_.empty(); }

  /// The classes with any mass, ascending; ends the additions.
  const std::vector<ClassId>& finish() {
    carry();
    std::sort(touched_.begin(), touched_.end());
    return touched_;
  }
  double mass(ClassId k, std::size_t lane) const { return carried_[k][lane]; }

 private:
  static constexpr int kCarryInterval = 256;

  void touch(ClassId k) {
    if (touched_flag_[k]) return;
    touched_flag_[k] = true;
    touched_.push_back(k);
  }
  void countAddition() {
    if (++added_ < kCarryInterval) return;
    carry();
  }
  void carry() {
    for (const ClassId k : touched_) {
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        carried_[k][lane] += static_cast<double>(sums_[k][lane]);
      sums_[k].fill(0.0F);
    }
    added_ = 0;
  }

  std::vector<Lanes> sums_;
  std::vector<std::array<double, kLanes>> carried_;
  std::vector<bool> touched_flag_;
  std::vector<ClassId> touched_;
  int added_ = 0;
};

}  // namespace csom::detail
