// SPDX-License-Identifier: BSD-3-Clause
#include "image/DepthCube.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "image/FacePainter.h"
#include "util/Parallel.h"

namespace csom::detail {

namespace {

/// Where a voxel is as wide as a pixel, if beams do not ask for wider ones [m].
constexpr double kVoxelAsWideAsPixel = 25;

/// Root mean square of the sine between adjacent beams of a row; 0 if there are none.
double spacingOf(const ImageBeams& beams) {
  double sum = 0;
  double count = 0;
  for (std::size_t a = 0; a < beams.size(); ++a) {
    if (beams.neighbours.next[a] == kNoBeam) continue;
    const BeamVector one = beams.end(a);
    const BeamVector next = beams.end(static_cast<std::size_t>(beams.neighbours.next[a]));
    const float both = squaredNorm(one) * squaredNorm(next);
    if (!(both > 0)) continue;
    sum += squaredCross(one, next) / both;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

}  // namespace

void DepthCube::draw(const ImageBeams& beams, const Facets& facets, const Options& options) {
  grid_ =
      CubeGrid::forSpacing(std::max(spacingOf(beams), options.resolution / kVoxelAsWideAsPixel));
  projections_.compute(beams, options.threads);
  parallelRanges(faces_.size(), options.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t face = begin; face < end; ++face)
      FacePainter(grid_, static_cast<int>(face), beams, facets, projections_, faces_[face]).run();
  });
}

bool DepthCube::isAllBehind(const CubeWindow& window) const {
  const DepthFace& face = faceAt(window.face);
  if (face.empty) return true;
  const float limit = 1 / window.nearest;
  const int level = grid_.levelOf(window);
  const int side = grid_.side() >> level;
  const float* const pixels = level == 0 ? face.nearest.level(0) : face.farthest.level(level);
  for (int v = window.first_v >> level; v <= window.last_v >> level; ++v)
    for (int u = window.first_u >> level; u <= window.last_u >> level; ++u) {
      const float inverse = pixels[v * side + u];
      if (inverse > 0 && inverse <= limit) return false;
    }
  return true;
}

namespace {

CSOM_INLINE Lanes load(const ChunkBoxes::Bounds& bounds) {
  Lanes lanes;
  std::memcpy(&lanes, bounds.data(), sizeof lanes);
  return lanes;
}

/// The nearest of a face, see DepthFace.
struct SquareImage {
  const float* squares;
  std::int32_t half_side;
  std::int32_t last_level;
};

/// What eight voxels lie behind along an axis.
struct alignas(kLaneAlignment) PixelRange {
  IntLanes first, last;
};
/// Inverse depths of eight voxels: at their nearest and at their farthest.
struct alignas(kLaneAlignment) InverseDepths {
  Lanes near, far;
};

CSOM_INLINE IntLanes pixelsOf(const IntLanes& from_centre, const SquareImage& image) {
  const IntLanes last = IntLanes{} + std::max(2 * image.half_side - 1, 0);
  const IntLanes pixel = from_centre + image.half_side;
  const IntLanes positive = pixel < 0 ? IntLanes{} : pixel;
  return positive > last ? last : positive;
}
CSOM_INLINE IntLanes floorOf(const Lanes& v) {
  const IntLanes whole = __builtin_convertvector(v, IntLanes);  // towards 0
  return whole + (__builtin_convertvector(whole, Lanes) > v);
}
/// CubeGrid::window() of eight voxels along u or v.
CSOM_INLINE PixelRange rangeOf(const Lanes& min, const Lanes& max, const InverseDepths& inverse,
                               const SquareImage& image) {
  const auto half_side = static_cast<float>(image.half_side);
  const Lanes lower = min * (min < 0 ? inverse.near : inverse.far) * half_side;
  const Lanes upper = max * (max > 0 ? inverse.near : inverse.far) * half_side;
  const IntLanes whole_lower = __builtin_convertvector(lower, IntLanes);
  const IntLanes ceiling = whole_lower - (__builtin_convertvector(whole_lower, Lanes) < lower);
  return {pixelsOf(ceiling - 1, image), pixelsOf(floorOf(upper), image)};
}

/// Looks through one face at the voxels of a chunk. What a voxel lies behind along u depends on
/// where it lies along u and the depth alone, and so along v: both are found for eight at once.
struct alignas(kLaneAlignment) ChunkView {
  /// Inverse of the depth up to which a voxel must be seen through, of rows along x; by z if that
  /// is the depth, else by y. 0: it reaches the plane of the sensor and cannot be.
  std::array<Lanes, kChunkSide> far;
  /// Along u, of the same rows; along v, of rows along x by z if x is the depth, else of rows along
  /// v by depth.
  std::array<PixelRange, kChunkSide> u, v;
  /// Whether the centre is seen through the face, of rows along x by y and z.
  std::array<IntLanes, kChunkSide * kChunkSide> seen;
};

CSOM_EVERY_PROCESSOR
void lookAt(const ChunkBoxes& boxes, int face, bool one_face, const SquareImage& image,
            ChunkView& view) {
  const FaceAxes axes(face);
  const ChunkBoxes::Bounds& first = axes.positive ? boxes.min[axes.depth] : boxes.max[axes.depth];
  const ChunkBoxes::Bounds& last = axes.positive ? boxes.max[axes.depth] : boxes.min[axes.depth];
  const float sign = axes.positive ? 1 : -1;
  // What is not in front of the sensor has no range of pixels: any numbers.
  const auto nearOf = [&](std::size_t i) { return sign * first[i] > 0 ? sign / first[i] : 1; };
  const auto farOf = [&](std::size_t i) { return sign * first[i] > 0 ? sign / last[i] : 0; };
  if (axes.depth == 0) {
    InverseDepths inverse;
    for (std::size_t i = 0; i < kLanes; ++i) {
      inverse.near[i] = nearOf(i);
      inverse.far[i] = farOf(i);
    }
    for (std::size_t i = 0; i < kChunkSide; ++i) {
      view.far[i] = inverse.far;
      view.u[i] = rangeOf(Lanes{} + boxes.min[1][i], Lanes{} + boxes.max[1][i], inverse, image);
      view.v[i] = rangeOf(Lanes{} + boxes.min[2][i], Lanes{} + boxes.max[2][i], inverse, image);
    }
  } else {
    for (std::size_t i = 0; i < kChunkSide; ++i) {
      const InverseDepths inverse{Lanes{} + nearOf(i), Lanes{} + farOf(i)};
      view.far[i] = inverse.far;
      view.u[i] = rangeOf(load(boxes.min[0]), load(boxes.max[0]), inverse, image);
      view.v[i] = rangeOf(load(boxes.min[axes.v]), load(boxes.max[axes.v]), inverse, image);
    }
  }
  if (one_face) return;
  const auto centre = [&](std::size_t axis, std::size_t i) {
    return boxes.min[axis][i] + boxes.max[axis][i];
  };
  for (std::size_t z = 0; z < kChunkSide; ++z)
    for (std::size_t y = 0; y < kChunkSide; ++y) {
      const std::array<Lanes, 3> at{load(boxes.min[0]) + load(boxes.max[0]), Lanes{} + centre(1, y),
                                    Lanes{} + centre(2, z)};
      const Lanes depth = sign * at[axes.depth];
      const auto reaches = [&](const Lanes& v) { return depth >= (v < 0 ? -v : v); };
      view.seen[8 * z + y] = (depth > 0) & reaches(at[axes.u]) & reaches(at[axes.v]);
    }
}

/// As VoxelsInFront, of a row along x: bit i is that of voxel i.
struct RowInFront {
  std::uint32_t in_front;
  std::uint32_t all_seen;
};

/// Voxels that are not seen through the face pass.
CSOM_EVERY_PROCESSOR
RowInFront rowInFront(const ChunkView& view, std::size_t y, std::size_t z, std::size_t depth_axis,
                      bool one_face, const SquareImage& image) {
  const std::size_t depth = depth_axis == 2 ? z : y;
  const PixelRange& u = view.u[depth];
  PixelRange v = view.v[depth_axis == 0 ? z : depth];
  if (depth_axis != 0) {
    const std::size_t lane = depth_axis == 1 ? z : y;
    v = {IntLanes{} + v.first[lane], IntLanes{} + v.last[lane]};
  }
  // The exponent of a number is the whole part of its logarithm.
  const IntLanes size_u = u.last - u.first;
  const IntLanes size_v = v.last - v.first;
  const Lanes longer = __builtin_convertvector((size_u > size_v ? size_u : size_v) + 1, Lanes);
  IntLanes level;
  std::memcpy(&level, &longer, sizeof level);
  level = (level >> 23) - 127;
  level = level < image.last_level ? level : IntLanes{} + image.last_level;
  level = level > 0 ? level : IntLanes{};  // also where voxels are not seen through the face
  const IntLanes back = ((IntLanes{} + 1) << level) - 1;
  const IntLanes before_u = u.last - back;
  const IntLanes before_v = v.last - back;
  const IntLanes second_u = before_u > 0 ? before_u : IntLanes{};
  const IntLanes second_v = before_v > 0 ? before_v : IntLanes{};
  const std::int32_t side = 2 * image.half_side;
  const IntLanes upper = (level * side + v.first) * side;
  const IntLanes lower = (level * side + second_v) * side;
  const std::array<IntLanes, 4> squares{upper + u.first, upper + second_u, lower + u.first,
                                        lower + second_u};
  Lanes inverse{};
  IntLanes signs{};
  for (const IntLanes& square : squares) {
    Lanes here;
    for (std::size_t lane = 0; lane < kLanes; ++lane) here[lane] = image.squares[square[lane]];
    IntLanes bits;
    std::memcpy(&bits, &here, sizeof bits);
    signs |= bits;
    here = here < 0 ? -here : here;
    inverse = inverse > here ? inverse : here;
  }
  IntLanes in_front = (inverse <= view.far[depth]) & (inverse > 0);
  IntLanes all_seen = signs >= 0;
  if (!one_face) {
    const IntLanes not_seen = view.seen[8 * z + y] == 0;
    in_front |= not_seen;
    all_seen |= not_seen;
  }
  RowInFront row{0, 0};
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    row.in_front |= static_cast<std::uint32_t>(in_front[lane] & 1) << lane;
    row.all_seen |= static_cast<std::uint32_t>(all_seen[lane] & 1) << lane;
  }
  return row;
}

}  // namespace

void DepthCube::keepInFront(const ChunkBoxes& boxes, int face, bool one_face,
                            VoxelsInFront& voxels) const {
  const SquareImage image = faceAt(face).empty ? SquareImage{&DepthFace::kNothing, 0, 0}
                                               : SquareImage{faceAt(face).nearest.level(0),
                                                             grid_.side() / 2, grid_.levels() - 2};
  ChunkView view;
  lookAt(boxes, face, one_face, image, view);
  const std::size_t depth_axis = FaceAxes(face).depth;
  for (std::size_t z = 0; z < kChunkSide; ++z) {
    std::uint64_t in_front = 0;
    std::uint64_t all_seen = 0;
    for (std::size_t y = 0; y < kChunkSide; ++y) {
      const RowInFront row = rowInFront(view, y, z, depth_axis, one_face, image);
      in_front |= std::uint64_t{row.in_front} << (8 * y);
      all_seen |= std::uint64_t{row.all_seen} << (8 * y);
    }
    voxels.in_front[z] &= in_front;
    voxels.all_seen[z] &= all_seen;
  }
}

}  // namespace csom::detail
