// SPDX-License-Identifier: BSD-3-Clause
// Draws the surfaces of a scan on one face of a cube around its sensor.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "image/CubeGrid.h"
#include "image/DepthPyramid.h"
#include "image/Facets.h"
#include "image/ImageBeams.h"

namespace csom::detail {

/// Where beams pass the cube.
struct BeamProjections {
  void compute(const ImageBeams& beams, int threads);

  /// Each beam on the face that it passes: u, v and the inverse of the depth.
  std::vector<std::uint8_t> face;
  std::vector<float> u, v, inverse;
  /// Of each face the first corners of the quadrilaterals that may show on it.
  std::array<std::vector<BeamId>, CubeGrid::kFaces> quads;
};

class FacePainter {
 public:
  FacePainter(const CubeGrid& grid, int face, const ImageBeams& beams, const Facets& facets,
              const BeamProjections& projections, DepthFace& out)
      : grid_(grid),
        face_(face),
        axes_(face),
        beams_(beams),
        facets_(facets),
        projections_(projections),
        out_(out) {}

  void run();

 private:
  using Corners = std::array<std::size_t, 4>;  ///< a, the one beside it, and those above them
  struct Projection {
    float u, v, inverse;
  };
  using Triangle = std::array<Projection, 3>;
  struct Bounds;
  struct PixelBox {
    int first_u, last_u, first_v, last_v;
  };
  struct Plane;

  void draw(const Corners& corners);
  Projection project(std::size_t beam) const;
  bool isSurface(const Corners& corners) const;
  template <std::size_t N>
  static Bounds boundsOf(const std::array<Projection, N>& corners);
  PixelBox pixelsOf(const Bounds& bounds) const;
  static float areaOf(const Triangle& triangle);
  static Plane flat(float inverse);
  Plane planeThrough(const Triangle& triangle) const;
  void fill(const PixelBox& box, const Plane& plane);
  void fillTriangle(const Triangle& triangle, const Plane& plane);
  void prepare(const PixelBox& box);
  void put(int u, int v, float inverse);

  void closeGaps();
  void buildPyramids();
  void shrink(int level);
  void slide(int level);

  const CubeGrid& grid_;
  int face_;
  FaceAxes axes_;
  const ImageBeams& beams_;
  const Facets& facets_;
  const BeamProjections& projections_;
  DepthFace& out_;
  float* image_ = nullptr;  ///< the lowest level of what is drawn
  std::size_t side_ = 0;
  PixelRectangle drawn_;
  double spacings_ = 0;
  double drawings_ = 0;
};

}  // namespace csom::detail
