// SPDX-License-Identifier: BSD-3-Clause
// How far a scan sees in each direction: its surfaces drawn on a cube around the sensor.
#pragma once

#include <csom/core/Grid.h>
#include <csom/core/Options.h>

#include <array>
#include <cstdint>

#include "image/CubeGrid.h"
#include "image/DepthPyramid.h"
#include "image/FacePainter.h"
#include "image/Facets.h"
#include "image/ImageBeams.h"
#include "util/Lanes.h"

namespace csom::detail {

/// The cubes of the voxels of a chunk: of those at each position along each axis the bounds,
/// relative to the sensor [m].
struct ChunkBoxes {
  using Bounds = std::array<float, kChunkSide>;
  std::array<Bounds, 3> min, max;
};

/// Voxels of a chunk, a bit each.
struct VoxelsInFront {
  using Voxels = std::array<std::uint64_t, kVoxelsPerChunk / 64>;
  Voxels in_front;  ///< of something that was drawn in their window, and behind nothing of it
  Voxels all_seen;  ///< all of their window was drawn
};

/// A pixel of the cube holds the inverse of the depth [1/m] at which something may be seen there at
/// the nearest.
///
/// What is drawn are the quadrilaterals between four adjacent beams, two of a row and those above
/// them. Where all four sides are surface, a pixel has the depth of the plane through three corners
/// at the nearest of its area, else that of the nearest corner. So whatever lies in front of what
/// was drawn was looked through. Where nothing was drawn, nothing is known: beams get lost.
class CSOM_OF_ONE_BINARY DepthCube {
 public:
  void draw(const ImageBeams& beams, const Facets& facets, const Options& options);

  const CubeGrid& grid() const { return grid_; }

  /// Takes out voxels that do not lie in front, or are not seen as a whole. Asks those whose centre
  /// is seen through the face; all of them if they are all seen through this `one_face`.
  ///
  /// A window is looked at through squares of pixels: of the largest edge 2^n that is no longer
  /// than its longer side, at each of its corners, inside it along that side.
  void keepInFront(const ChunkBoxes& boxes, int face, bool one_face, VoxelsInFront& voxels) const;
  /// Whether the box, and every box in it, lies behind all that was drawn, if any was.
  bool isAllBehind(const CubeWindow& window) const;

  /// Mean distance of adjacent beams [m] where a face is a depth [m] away; 0 if none pass it.
  float spacing(int face, float depth) const {
    return faceAt(face).empty ? 0 : faceAt(face).spacing * depth;
  }

 private:
  const DepthFace& faceAt(int face) const { return faces_[static_cast<std::size_t>(face)]; }
  CubeGrid grid_ = CubeGrid::forSpacing(1);
  std::array<DepthFace, CubeGrid::kFaces> faces_;
  BeamProjections projections_;  ///< kept for the next scan
};

}  // namespace csom::detail
