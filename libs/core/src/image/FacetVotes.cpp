// SPDX-License-Identifier: BSD-3-Clause
#include "image/FacetVotes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "inference/BoundedWords.h"
#include "util/Lanes.h"

namespace csom::detail {

namespace {

constexpr float kPieceVoxels = 0.4F;
constexpr std::int32_t kMostPieces = 2047;
/// Of a score of 1.
constexpr float kShares = 65536;

/// Of places at these distances from what was measured [m], to be rounded down [quanta].
CSOM_INLINE Lanes weightAt(const Lanes& distance) {
  return kPartOfWord * kFullWord / (1 + distance * distance) + 0.5F;
}

std::int32_t voxelOf(std::int32_t position) {
  return position >> HalfStepPosition::kBits;
}

/// Whether a segment passes through no other voxels than those of its ends, which have hits: one,
/// or two side by side.
bool isInVoxelsOfItsEnds(const HalfStepPosition& from, const HalfStepPosition& to) {
  const auto apart = [](std::int32_t a, std::int32_t b) {
    return std::abs(voxelOf(a) - voxelOf(b));
  };
  return apart(from.x, to.x) + apart(from.y, to.y) + apart(from.z, to.z) <= 1;
}

/// Points that divide a facet: their voxels and weights. Room for whole vectors.
struct FacetPoints {
  static constexpr int kMost = kMostPieces - 1 + static_cast<int>(kLanes);
  std::array<std::int32_t, kMost> x, y, z;
  std::array<std::uint32_t, kMost> weight;
};

/// Pieces of facets that single precision divides.
constexpr std::int32_t kFewPieces = 41;

/// One coordinate of the points from 1 to pieces − 1, eight at a time.
///
/// `pieces` is odd, and so are the ends: no point lies on a border between voxels, all are at least
/// 1/pieces of a unit away from it. Errors are smaller.
CSOM_INLINE void divideFew(std::int32_t from, std::int32_t to, std::int32_t pieces,
                           std::int32_t* voxels) {
  // The ends are less than so many voxels apart; the fraction of a unit takes the other bits.
  constexpr std::int32_t kMostApart = 18;
  static_assert(kFewPieces * kPieceVoxels < kMostApart - 1);
  constexpr std::int32_t kUnit = 1 << HalfStepPosition::kBits;
  const float length = static_cast<float>(to - from) / static_cast<float>(pieces);
  const float start = static_cast<float>((from & (kUnit - 1)) + kMostApart * kUnit);
  const std::int32_t first_voxel = voxelOf(from) - kMostApart;
  Lanes count{1, 2, 3, 4, 5, 6, 7, 8};
  for (std::int32_t i = 1; i < pieces; i += static_cast<std::int32_t>(kLanes)) {
    const IntLanes at = __builtin_convertvector(start + count * length, IntLanes);  // positive
    const IntLanes lanes = (at >> HalfStepPosition::kBits) + first_voxel;
    std::memcpy(voxels + i - 1, &lanes, sizeof lanes);
    count += static_cast<float>(kLanes);
  }
}

/// The same for any number of pieces. What is left out of a step adds up to less than 1/pieces.
CSOM_INLINE void divideMany(std::int32_t from, std::int32_t to, std::int32_t pieces,
                            std::int32_t* voxels) {
  using LongLanes = std::uint64_t __attribute__((vector_size(kLanes * sizeof(std::uint64_t))));
  constexpr int kFractionBits = 24;
  constexpr int kShift = kFractionBits + HalfStepPosition::kBits;
  static_assert(kMostPieces * kMostPieces < 1 << kFractionBits, "steps are exact enough");
  // Vectors shift unsigned numbers only: positions are counted from far below.
  constexpr std::int32_t kBelow = 1 << 24;  // voxels
  const std::int64_t step = (std::int64_t{to} - from) * (1 << kFractionBits) / pieces;
  const std::int64_t start =
      std::int64_t{from} * (1 << kFractionBits) + (std::int64_t{kBelow} << kShift);
  LongLanes at;
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    at[lane] = static_cast<std::uint64_t>(start + static_cast<std::int64_t>(lane + 1) * step);
  const auto steps = static_cast<std::uint64_t>(step * static_cast<std::int64_t>(kLanes));
  for (std::int32_t i = 1; i < pieces; i += static_cast<std::int32_t>(kLanes)) {
    const IntLanes lanes = __builtin_convertvector(at >> kShift, IntLanes) - kBelow;
    std::memcpy(voxels + i - 1, &lanes, sizeof lanes);
    at += steps;
  }
}

CSOM_EVERY_PROCESSOR
void dividePoints(const HalfStepPosition& from, const HalfStepPosition& to, std::int32_t pieces,
                  float piece, FacetPoints& points) {
  if (pieces <= kFewPieces) {
    divideFew(from.x, to.x, pieces, points.x.data());
    divideFew(from.y, to.y, pieces, points.y.data());
    divideFew(from.z, to.z, pieces, points.z.data());
  } else {
    divideMany(from.x, to.x, pieces, points.x.data());
    divideMany(from.y, to.y, pieces, points.y.data());
    divideMany(from.z, to.z, pieces, points.z.data());
  }
  IntLanes count{1, 2, 3, 4, 5, 6, 7, 8};
  for (std::int32_t i = 1; i < pieces; i += static_cast<std::int32_t>(kLanes)) {
    const IntLanes to_end = pieces - count;
    const IntLanes nearer = count < to_end ? count : to_end;
    const Lanes distance = piece * __builtin_convertvector(nearer, Lanes);
    const IntLanes weights = __builtin_convertvector(weightAt(distance), IntLanes);
    std::memcpy(points.weight.data() + i - 1, &weights, sizeof weights);
    count += static_cast<std::int32_t>(kLanes);
  }
}

class FacetDrawing {
 public:
  FacetDrawing(const ImageBeams& beams, const Options& options, VoxelWords& words)
      : beams_(beams),
        words_(words),
        pieces_per_metre_(1 / (kPieceVoxels * static_cast<float>(options.resolution))) {}

  void draw(std::size_t a, std::size_t b, Facets::Kind kind) {
    const HalfStepPosition& from = beams_.positions[beams_.neighbours.point[a]];
    const HalfStepPosition& to = beams_.positions[beams_.neighbours.point[b]];
    if (isInVoxelsOfItsEnds(from, to)) return;
    const float length = std::sqrt(squaredNorm(between(beams_.end(a), beams_.end(b))));
    const float wanted = std::min(length * pieces_per_metre_, static_cast<float>(kMostPieces));
    const auto whole = static_cast<std::int32_t>(wanted);  // towards 0: no call as std::ceil() is
    const std::int32_t pieces = (whole + (static_cast<float>(whole) < wanted ? 1 : 0)) | 1;
    dividePoints(from, to, pieces, length / static_cast<float>(pieces), points_);
    const auto half = static_cast<std::size_t>(pieces) / 2;
    vote(0, half, beams_.label[kind == Facets::kOfSecond ? b : a]);
    vote(half, static_cast<std::size_t>(pieces) - 1,
         beams_.label[kind == Facets::kOfFirst ? a : b]);
  }

 private:
  /// The points of a voxel follow each other: the largest of their weights is all it is asked for.
  void vote(std::size_t begin, std::size_t end, ClassId label) {
    for (std::size_t i = begin; i < end;) {
      const std::int32_t x = points_.x[i];
      const std::int32_t y = points_.y[i];
      const std::int32_t z = points_.z[i];
      std::uint32_t weight = points_.weight[i];
      for (++i; i < end && points_.x[i] == x && points_.y[i] == y && points_.z[i] == z; ++i)
        weight = std::max(weight, points_.weight[i]);
      words_.addFacet(x, y, z, label, weight);
    }
  }

  const ImageBeams& beams_;
  VoxelWords& words_;
  float pieces_per_metre_;
  FacetPoints points_;
};

}  // namespace

void addHits(const PreparedScan& scan, const ImageBeams& beams, const Options& options,
             std::size_t begin, std::size_t end, VoxelWords& words) {
  const ImagePoints& points = scan.image_points;
  const auto classes = static_cast<std::size_t>(options.number_of_classes);
  for (std::size_t i = begin; i < end; ++i) {
    const HalfStepPosition& p = beams.positions[i];
    const std::int32_t x = voxelOf(p.x);
    const std::int32_t y = voxelOf(p.y);
    const std::int32_t z = voxelOf(p.z);
    if (points.scores.empty()) {
      words.addHit(x, y, z, points.labels[i], 1);
      continue;
    }
    for (std::size_t k = 0; k < classes; ++k) {
      const auto share =
          static_cast<std::uint32_t>(points.scores[i * classes + k] * kShares + 0.5F);
      if (share > 0) words.addHit(x, y, z, static_cast<ClassId>(k), share);
    }
  }
}

void addFacets(const ImageBeams& beams, const Facets& facets, const Options& options,
               std::size_t begin, std::size_t end, VoxelWords& words) {
  FacetDrawing drawing(beams, options, words);
  const BeamNeighbours& n = beams.neighbours;
  for (std::size_t i = begin; i < end; ++i) {
    if (facets.to_next[i] != Facets::kNone)
      drawing.draw(i, static_cast<std::size_t>(n.next[i]), facets.to_next[i]);
    if (facets.to_above[i] != Facets::kNone)
      drawing.draw(i, static_cast<std::size_t>(n.above[i]), facets.to_above[i]);
  }
}

}  // namespace csom::detail
