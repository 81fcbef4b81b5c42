// SPDX-License-Identifier: BSD-3-Clause
#include "image/CubeGrid.h"

#include <algorithm>
#include <cmath>

namespace csom::detail {

CubeGrid CubeGrid::forSpacing(double sine) {
  constexpr int kFewest = 5;  // levels: 16 pixels
  constexpr int kMost = 10;
  int levels = kFewest;
  while (levels < kMost && sine * (1 << (levels - 1)) < 2) ++levels;
  return CubeGrid(levels);
}

int CubeGrid::faceOf(float x, float y, float z) {
  const float ax = std::abs(x);
  const float ay = std::abs(y);
  const float az = std::abs(z);
  if (ax >= ay && ax >= az) return x >= 0 ? 0 : 1;
  if (ay >= az) return y >= 0 ? 2 : 3;
  return z >= 0 ? 4 : 5;
}

/// A box as a face sees it.
struct CubeGrid::FaceBox {
  float nearest, farthest;  ///< depth
  float min_u, max_u, min_v, max_v;
};

CubeGrid::FaceBox CubeGrid::seenThrough(int face, const SpaceBox& box) {
  const FaceAxes axes(face);
  return {axes.positive ? box.min[axes.depth] : -box.max[axes.depth],
          axes.positive ? box.max[axes.depth] : -box.min[axes.depth],
          box.min[axes.u],
          box.max[axes.u],
          box.min[axes.v],
          box.max[axes.v]};
}

CubeWindow CubeGrid::window(int face, const FaceBox& box) const {
  const float near = 1 / box.nearest;
  const float far = 1 / box.farthest;
  const auto lower = [&](float min) { return min * (min < 0 ? near : far); };
  const auto upper = [&](float max) { return max * (max > 0 ? near : far); };
  return {face,
          firstPixel(lower(box.min_u)),
          lastPixel(upper(box.max_u)),
          firstPixel(lower(box.min_v)),
          lastPixel(upper(box.max_v)),
          box.nearest,
          box.farthest};
}

CubeWindows CubeGrid::windowsOf(const SpaceBox& box) const {
  CubeWindows windows;
  const auto least = [](float min, float max) { return std::max({0.0F, min, -max}); };
  for (int face = 0; face < kFaces; ++face) {
    FaceBox seen = seenThrough(face, box);
    // Of what a face shows, the depth is at least the distance along the other axes.
    seen.nearest =
        std::max({seen.nearest, least(seen.min_u, seen.max_u), least(seen.min_v, seen.max_v)});
    if (!(seen.farthest >= seen.nearest)) continue;
    windows.add(seen.nearest > 0 ? window(face, seen)
                                 : CubeWindow{face, 0, side_ - 1, 0, side_ - 1, 0, seen.farthest});
  }
  return windows;
}

int CubeGrid::mostBeside(float edge, float nearest) const {
  // A box that is seen through a face is wider along one axis than along the other by a factor of
  // (d + |u|) / d ≤ 2, of 2e/d at most; and either has up to two pixels more than it is wide.
  return static_cast<int>(std::min(edge / nearest * halfSide(), static_cast<float>(side_))) + 3;
}

int CubeGrid::levelOf(const CubeWindow& window) const {
  constexpr int kFew = 4;  // fewer are cheaper to look at, more are surer to tell
  const int size = std::max(window.last_u - window.first_u, window.last_v - window.first_v);
  int level = 0;
  while (size >> level > kFew) ++level;
  return level;
}

}  // namespace csom::detail
