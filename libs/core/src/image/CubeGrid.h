// SPDX-License-Identifier: BSD-3-Clause
// The pixels of a cube around a sensor, and which of them a box of space lies behind.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace csom::detail {

/// A box of space, relative to the sensor [m].
struct SpaceBox {
  std::array<float, 3> min, max;
};

/// Of the depth of a face, of u, and of v: the axis of the face, and the other two in their order.
struct FaceAxes {
  explicit FaceAxes(int face)
      : depth(static_cast<std::size_t>(face) / 2),
        u(depth == 0 ? 1 : 0),
        v(depth == 2 ? 1 : 2),
        positive(face % 2 == 0) {}
  std::size_t depth, u, v;
  bool positive;  ///< whether the depth grows with its axis
};

/// The pixels of a face that a box lies behind, borders included, and how far away it is.
struct CubeWindow {
  int face;
  int first_u, last_u, first_v, last_v;
  float nearest, farthest;  ///< depth [m]
};

/// Windows on some faces, at most one on each.
class CubeWindows {
 public:
  void add(const CubeWindow& window) { windows_[size_++] = window; }
  const CubeWindow* begin() const { return windows_.data(); }
  const CubeWindow* end() const { return windows_.data() + size_; }
  std::size_t size() const { return size_; }

 private:
  std::array<CubeWindow, 6> windows_{};
  std::size_t size_ = 0;
};

/// Six faces with axes parallel to the map's: +x, −x, +y, −y, +z, −z. The face towards +x is seen
/// through (1, u, v) with u and v from −1 to 1, in side × side pixels; in the pyramid over it each
/// level has half as many along an axis as the one below. What lies on the border of two pixels is
/// in both, so that a mirrored scan has mirrored pixels.
class CubeGrid {
 public:
  static constexpr int kFaces = 6;
  /// For what is so far apart, as sine of an angle: pixels no wider, of 16 to 512 along an axis.
  static CubeGrid forSpacing(double sine);

  int side() const { return side_; }
  int levels() const { return levels_; }

  static int faceOf(float x, float y, float z);
  /// u is less than 2²⁰.
  int firstPixel(float u) const {
    const float scaled = u * halfSide();
    const int whole = static_cast<int>(scaled);  // towards 0: no call as std::ceil() is
    return clampPixel(whole + (static_cast<float>(whole) < scaled ? 1 : 0) - 1 + side_ / 2);
  }
  int lastPixel(float u) const {
    const float scaled = u * halfSide();
    const int whole = static_cast<int>(scaled);
    return clampPixel(whole - (static_cast<float>(whole) > scaled ? 1 : 0) + side_ / 2);
  }
  float centreOf(int pixel) const {
    return (static_cast<float>(pixel - side_ / 2) + 0.5F) * pixel_width_;
  }
  float halfSide() const { return static_cast<float>(side_ / 2); }

  // A box inside another one has a window inside the other's, rounding included.

  /// As much of the box as is seen through each face, for those that show any of it.
  CubeWindows windowsOf(const SpaceBox& box) const;
  /// How far outside of the windows of boxes of an edge, no nearer than a depth, the squares lie at
  /// most that are no longer than the longer side of each [pixels].
  int mostBeside(float edge, float nearest) const;
  /// The level of the pyramid at which a window has a few pixels along each axis.
  int levelOf(const CubeWindow& window) const;

 private:
  int clampPixel(int pixel) const { return std::min(std::max(pixel, 0), side_ - 1); }
  explicit CubeGrid(int levels)
      : levels_(levels), side_(1 << (levels - 1)), pixel_width_(2 / static_cast<float>(side_)) {}
  struct FaceBox;
  static FaceBox seenThrough(int face, const SpaceBox& box);
  CubeWindow window(int face, const FaceBox& box) const;

  int levels_;
  int side_;
  float pixel_width_;  ///< a power of two: products with it are exact
};

}  // namespace csom::detail
