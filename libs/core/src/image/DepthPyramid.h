// SPDX-License-Identifier: BSD-3-Clause
// Inverse depths of the pixels of one face of a cube, and of ever larger squares of them.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

namespace csom::detail {

/// Zeros that take no memory until they are written to: most of a face is never drawn.
class LazyZeros {
 public:
  void allocate(std::size_t size) {
    numbers_.reset(static_cast<float*>(std::calloc(size, sizeof(float))));
    if (numbers_ == nullptr) throw std::bad_alloc();
  }
  bool empty() const { return numbers_ == nullptr; }
  float* data() { return numbers_.get(); }
  const float* data() const { return numbers_.get(); }

 private:
  struct Free {
    void operator()(float* numbers) const { std::free(numbers); }
  };
  std::unique_ptr<float[], Free> numbers_;
};

/// Level after level, each half as wide as the one below. 0 is where nothing was drawn.
class DepthPyramid {
 public:
  void allocate(int side, int levels) {
    side_ = static_cast<std::size_t>(side);
    pixels_.allocate(offset(levels));
  }
  bool empty() const { return pixels_.empty(); }

  float* level(int level) { return pixels_.data() + offset(level); }
  const float* level(int level) const { return pixels_.data() + offset(level); }

 private:
  std::size_t offset(int level) const {
    const std::size_t all = 4 * side_ * side_;
    return (all - (all >> (2 * static_cast<unsigned>(level)))) / 3;
  }

  LazyZeros pixels_;
  std::size_t side_ = 0;
};

/// Largest inverse depths of squares of 2^level pixels an edge, for each pixel at which one begins;
/// of as much of it as lies in the image. Four of them, overlapping, cover any larger window.
class SlidingMaxima {
 public:
  void allocate(int side, int levels) {
    side_ = static_cast<std::size_t>(side);
    squares_.allocate(static_cast<std::size_t>(levels) * side_ * side_);
  }
  bool empty() const { return squares_.empty(); }

  /// Row after row; levels lie one after the other.
  float* level(int level) {
    return squares_.data() + static_cast<std::size_t>(level) * side_ * side_;
  }
  const float* all() const { return squares_.data(); }

 private:
  LazyZeros squares_;
  std::size_t side_ = 0;
};

/// What is known about the pixels of one face. Empty if nothing was drawn.
struct DepthFace {
  SlidingMaxima nearest;  ///< the largest of what was drawn
  DepthPyramid complete;  ///< the same; 0 if not all was drawn
  DepthPyramid farthest;  ///< the smallest of what was drawn
  /// Mean distance of adjacent beams at a depth of 1, along the wider side of what was drawn.
  float spacing = 0;
};

}  // namespace csom::detail
