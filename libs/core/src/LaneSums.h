// SPDX-License-Identifier: BSD-3-Clause
// Sums of kernel mass by class for eight voxels at a time.
#pragma once

#include <csom/core/types.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "Lanes.h"

namespace csom::detail {

/// Class sums of the voxels of eight lanes. Single precision, carried over to double precision
/// every kCarryInterval points, so that a million points at one place still sum up right.
class LaneSums {
 public:
  explicit LaneSums(int number_of_classes)
      : sums_(static_cast<std::size_t>(number_of_classes)),
        carried_(static_cast<std::size_t>(number_of_classes)),
        touched_flag_(static_cast<std::size_t>(number_of_classes)) {}

  void reset() {
    for (const ClassId k : touched_) {
      sums_[k].mass = Lanes{};
      carried_[k].fill(0.0);
      touched_flag_[k] = 0;
    }
    touched_.clear();
    added_ = 0;
  }

  void add(ClassId k, const Lanes& mass) {
    touch(k);
    sums_[k].mass += mass;
    countAddition();
  }

  /// One point with a class vector of `sums_.size()` scores.
  void add(const float* scores, const Lanes& mass) {
    for (std::size_t k = 0; k < sums_.size(); ++k) {
      const float score = scores[k];
      if (score <= 0) continue;
      touch(static_cast<ClassId>(k));
      sums_[k].mass += mass * score;
    }
    countAddition();
  }

  std::size_t numberOfClasses() const { return sums_.size(); }
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

  struct alignas(kLaneAlignment) Sum {
    Lanes mass;
  };

  void touch(ClassId k) {
    if (touched_flag_[k] != 0) return;
    touched_flag_[k] = 1;
    touched_.push_back(k);
  }
  void countAddition() {
    if (++added_ < kCarryInterval) return;
    carry();
  }
  void carry() {
    for (const ClassId k : touched_) {
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        carried_[k][lane] += static_cast<double>(sums_[k].mass[lane]);
      sums_[k].mass = Lanes{};
    }
    added_ = 0;
  }

  std::vector<Sum> sums_;
  std::vector<std::array<double, kLanes>> carried_;
  std::vector<std::uint8_t> touched_flag_;
  std::vector<ClassId> touched_;
  int added_ = 0;
};

}  // namespace csom::detail
