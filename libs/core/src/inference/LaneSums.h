// SPDX-License-Identifier: BSD-3-Clause
// Sums of kernel mass by class for eight voxels at a time.
#pragma once

#include <csom/core/types.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "inference/Counts.h"
#include "util/Lanes.h"

namespace csom::detail {

/// Class sums of the voxels of eight lanes. Single precision, carried over to double precision
/// after every kCarryInterval points, so that a million points at one place still sum up right.
class LaneSums {
 public:
  static constexpr std::size_t kCarryInterval = 256;

  explicit LaneSums(int number_of_classes)
      : sums_(static_cast<std::size_t>(number_of_classes)),
        carried_(static_cast<std::size_t>(number_of_classes)),
        touched_flag_(static_cast<std::size_t>(number_of_classes)) {}

  void reset() {
    for (const ClassId k : touched_) {
      carried_[k].lanes = MassLanes{};
      touched_flag_[k] = 0;
    }
    touched_.clear();
  }

  /// Mass of points points[0] … points[size−1] with these labels; at most kCarryInterval of them
  /// between two calls of carry().
  CSOM_INLINE void add(const ClassId* labels, const std::uint32_t* points, const Lanes* masses,
                       std::size_t size) {
    for (std::size_t i = 0; i < size;) {
      const ClassId k = labels[points[i]];
      touch(k);
      Lanes sum = sums_[k].mass;  // neighbours mostly share a class: the sum stays in a register
      do {
        sum += masses[i];
      } while (++i < size && labels[points[i]] == k);
      sums_[k].mass = sum;
    }
  }

  /// The same with rows of scores, one a class.
  CSOM_INLINE void add(const float* scores, const std::uint32_t* points, const Lanes* masses,
                       std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
      const float* const row = scores + points[i] * sums_.size();
      for (std::size_t k = 0; k < sums_.size(); ++k) {
        if (row[k] <= 0) continue;
        touch(static_cast<ClassId>(k));
        sums_[k].mass += masses[i] * row[k];
      }
    }
  }

  CSOM_INLINE void carry() {
    for (const ClassId k : touched_) {
      carried_[k].lanes += __builtin_convertvector(sums_[k].mass, MassLanes);
      sums_[k].mass = Lanes{};
    }
  }

  /// Ends the additions: to be called before what follows.
  void finish() { std::sort(touched_.begin(), touched_.end()); }
  /// The classes with any mass, ascending.
  const std::vector<ClassId>& classes() const { return touched_; }
  const MassLanes& mass(ClassId k) const { return carried_[k].lanes; }

 private:
  struct alignas(kLaneAlignment) Sum {
    Lanes mass;
  };

  void touch(ClassId k) {
    if (touched_flag_[k] != 0) return;
    touched_flag_[k] = 1;
    touched_.push_back(k);
  }

  std::vector<Sum> sums_;
  std::vector<AlignedMassLanes> carried_;
  std::vector<std::uint8_t> touched_flag_;
  std::vector<ClassId> touched_;
};

}  // namespace csom::detail
