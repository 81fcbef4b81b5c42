// SPDX-License-Identifier: BSD-3-Clause
// Inverse depths of the pixels of one face of a cube, and of ever larger squares of them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace csom::detail {

/// Some pixels of a face: from the first ones up to the ends.
struct PixelRectangle {
  std::size_t first_u = 0, end_u = 0, first_v = 0, end_v = 0;

  bool empty() const { return first_u >= end_u || first_v >= end_v; }
  void add(const PixelRectangle& other) {
    if (empty()) {
      *this = other;
      return;
    }
    first_u = std::min(first_u, other.first_u);
    end_u = std::max(end_u, other.end_u);
    first_v = std::min(first_v, other.first_v);
    end_v = std::max(end_v, other.end_v);
  }
};

/// Levels of square images, row after row, one level after the other: `nothing` but for what is
/// written. Memory is kept from scan to scan, and cleared where it was written.
class ImageLevels {
 public:
  /// How many pixels an edge has, from the lowest level up.
  enum class Sides { Equal, Halved };
  ImageLevels(Sides sides, float nothing) : halved_(sides == Sides::Halved), nothing_(nothing) {}

  void reset(int side, int levels) {
    if (side == side_ && levels == levels_) {
      for (int l = 0; l < levels; ++l) clear(l);
      return;
    }
    side_ = side;
    levels_ = levels;
    pixels_.assign(offset(levels), nothing_);
    written_ = {};
  }
  /// To be called before pixels of a level are written.
  void willWrite(int level, const PixelRectangle& pixels) {
    written_[static_cast<std::size_t>(level)].add(pixels);
  }

  std::size_t sideOf(int level) const {
    return static_cast<std::size_t>(side_) >> (halved_ ? level : 0);
  }
  float* level(int level) { return pixels_.data() + offset(level); }
  const float* level(int level) const { return pixels_.data() + offset(level); }

 private:
  static constexpr std::size_t kMostLevels = 10;

  std::size_t offset(int level) const {
    const std::size_t one = sideOf(0) * sideOf(0);
    if (!halved_) return static_cast<std::size_t>(level) * one;
    return (4 * one - (4 * one >> (2 * static_cast<unsigned>(level)))) / 3;
  }
  void clear(int level) {
    PixelRectangle& written = written_[static_cast<std::size_t>(level)];
    const std::size_t side = sideOf(level);
    float* const pixels = this->level(level);
    for (std::size_t v = written.first_v; v < written.end_v && !written.empty(); ++v)
      std::fill(pixels + v * side + written.first_u, pixels + v * side + written.end_u, nothing_);
    written = {};
  }

  bool halved_;
  float nothing_;
  int side_ = 0;
  int levels_ = 0;
  std::vector<float> pixels_;
  std::array<PixelRectangle, kMostLevels> written_{};
};

/// What is known about the pixels of one face: inverse depths.
struct DepthFace {
  /// Of `nearest`: nothing was drawn.
  static constexpr float kNothing = -0.0F;

  bool empty = true;  ///< nothing was drawn, and nothing below is set
  /// The largest of squares of 2^level pixels an edge, for each pixel at which one begins, negative
  /// if some of the square was not drawn; of as much of it as lies in the image. Four of them,
  /// overlapping, cover any larger window.
  ImageLevels nearest{ImageLevels::Sides::Equal, kNothing};
  /// The smallest of what was drawn, infinite where nothing was, each level of four pixels of the
  /// one below, the first one of the lowest level of `nearest`. Level 0 is not used.
  ImageLevels farthest{ImageLevels::Sides::Halved, std::numeric_limits<float>::infinity()};
  /// Mean distance of adjacent beams at a depth of 1, along the wider side of what was drawn.
  float spacing = 0;
};

}  // namespace csom::detail
