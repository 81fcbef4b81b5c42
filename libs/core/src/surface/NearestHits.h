// SPDX-License-Identifier: BSD-3-Clause
// The k nearest hits of a hit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace csom::detail {

/// The nearest of the hits that were offered, nearest first. Of hits equally far the first offered
/// comes first.
class NearestHits {
 public:
  static constexpr std::size_t kMax = 64;

  /// Forgets all; from now on so many are wanted that are nearer than a distance.
  void reset(std::size_t wanted, float limit_squared) {
    wanted_ = wanted;
    size_ = 0;
    limit_ = limit_squared;
  }

  /// No hit as far as this or farther is wanted any more.
  float limitSquared() const { return limit_; }

  /// A hit nearer than that.
  void offer(float squared, std::uint32_t point) {
    std::size_t at = size_ < wanted_ ? size_++ : size_ - 1;
    for (; at > 0 && squared < squared_[at - 1]; --at) {
      squared_[at] = squared_[at - 1];
      points_[at] = points_[at - 1];
    }
    squared_[at] = squared;
    points_[at] = point;
    if (size_ == wanted_) limit_ = squared_[size_ - 1];
  }

  std::size_t size() const { return size_; }
  bool complete() const { return size_ == wanted_; }
  float squared(std::size_t i) const { return squared_[i]; }
  std::uint32_t point(std::size_t i) const { return points_[i]; }

 private:
  std::size_t wanted_ = 0;
  std::size_t size_ = 0;
  float limit_ = 0;
  std::array<float, kMax> squared_{};
  std::array<std::uint32_t, kMax> points_{};
};

}  // namespace csom::detail
