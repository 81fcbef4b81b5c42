// SPDX-License-Identifier: BSD-3-Clause
// Inverse depths of the pixels of one face of a cube, and of ever larger squares of them.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

namespace csom::detail {

/// Level after level, each half as wide as the one below. 0 is where nothing was drawn: memory
/// comes as zeros, and is not touched there.
class DepthPyramid {
 public:
  void allocate(int side) {
    side_ = static_cast<std::size_t>(side);
    std::size_t pixels = 0;
    for (std::size_t edge = side_; edge > 0; edge /= 2) pixels += edge * edge;
    pixels_.reset(static_cast<float*>(std::calloc(pixels, sizeof(float))));
    if (pixels_ == nullptr) throw std::bad_alloc();
  }
  bool empty() const { return pixels_ == nullptr; }

  float* level(int level) { return pixels_.get() + offset(level); }
  const float* level(int level) const { return pixels_.get() + offset(level); }

 private:
  std::size_t offset(int level) const {
    const std::size_t all = 4 * side_ * side_;
    return (all - (all >> (2 * static_cast<unsigned>(level)))) / 3;
  }
  struct Free {
    void operator()(float* pixels) const { std::free(pixels); }
  };

  std::unique_ptr<float[], Free> pixels_;
  std::size_t side_ = 0;
};

/// Largest inverse depths of squares of 2^level pixels an edge, for each pixel at which one begins;
/// as much of it as lies in the image. Four of them, overlapping, cover any larger window.
class SlidingMaxima {
 public:
  void allocate(int side) {
    side_ = static_cast<std::size_t>(side);
    std::size_t levels = 0;
    for (std::size_t edge = side_; edge > 1; edge /= 2) ++levels;
    squares_.reset(static_cast<float*>(std::calloc(levels * side_ * side_, sizeof(float))));
    if (squares_ == nullptr) throw std::bad_alloc();
  }
  bool empty() const { return squares_ == nullptr; }

  /// Row after row; levels lie one after the other.
  float* level(int level) {
    return squares_.get() + static_cast<std::size_t>(level) * side_ * side_;
  }
  const float* all() const { return squares_.get(); }

 private:
  struct Free {
    void operator()(float* squares) const { std::free(squares); }
  };

  std::unique_ptr<float[], Free> squares_;
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
