// SPDX-License-Identifier: BSD-3-Clause
#include "image/Facets.h"

#include <algorithm>
#include <cmath>

#include "util/Parallel.h"

namespace csom::detail {

namespace {

constexpr float kShortVoxels = 1.5F;
constexpr float kLongest = 20;  // [m]
/// Square of the cosine of 30°.
constexpr float kInLine = 0.75F;
constexpr float kExactFromVoxels = 5;
/// Of a line that is explained by errors of ranges, at right angles to the beam [m].
constexpr float kRangeError = 0.2F;
constexpr float kFlatRise = 0.08F;
constexpr float kFlatVoxels = 0.4F;
/// Of the side of something that stands on the ground.
constexpr float kSteepRise = 0.5F;

constexpr float square(float v) {
  return v * v;
}

/// Lengths that depend on the resolution [m²].
struct Limits {
  explicit Limits(float resolution)
      : short_squared(square(kShortVoxels * resolution)),
        exact_from_squared(square(kExactFromVoxels * resolution)),
        flat_squared(square(kFlatVoxels * resolution)) {}
  float short_squared;
  float exact_from_squared;
  float flat_squared;
};

class SegmentTest {
 public:
  SegmentTest(const ImageBeams& beams, const Limits& limits) : beams_(beams), limits_(limits) {}

  /// From beam a to b; `before` lies before a, `after` behind b, or there is none.
  Facets::Kind kindOf(BeamId a, BeamId b, BeamId before, BeamId after, bool across_rows) const {
    if (b == kNoBeam || isFree(a) || isFree(b)) return Facets::kNone;
    const BeamVector from = beams_.end(index(a));
    const BeamVector to = beams_.end(index(b));
    const BeamVector segment = between(from, to);
    const float squared = squaredNorm(segment);
    if (squared < limits_.short_squared) return Facets::kOfNearer;
    if (squared > square(kLongest)) return Facets::kNone;
    // (0.2 m · sin)² · squared · farther² without a quotient.
    const float tolerance = square(kRangeError) * squaredCross(from, to);
    const float farther = std::max(squaredNorm(from), squaredNorm(to)) * squared;
    const bool any_class = beams_.label[index(a)] == beams_.label[index(b)];
    const bool flat = across_rows && square(segment.z) < square(kFlatRise) * squared;
    if (!any_class && !flat) return Facets::kNone;
    const auto continues = [&](const BeamVector& other) {
      const float cosine = dot(other, segment);
      if (!(cosine > 0)) return false;
      const float other_squared = squaredNorm(other);
      const float deviation = squaredCross(segment, other);  // × other_squared
      if (!(square(cosine) > kInLine * squared * other_squared)) return false;
      if (!(squared < limits_.exact_from_squared ||
            deviation * farther < tolerance * other_squared))
        return false;
      return any_class || deviation < limits_.flat_squared * other_squared;
    };
    const bool has_before = before != kNoBeam && !isFree(before);
    const bool has_after = after != kNoBeam && !isFree(after);
    const BeamVector to_a = has_before ? between(beams_.end(index(before)), from) : BeamVector{};
    const BeamVector from_b = has_after ? between(to, beams_.end(index(after))) : BeamVector{};
    if (!(has_before && continues(to_a)) && !(has_after && continues(from_b))) return Facets::kNone;
    if (any_class || isSteep(to_a) == isSteep(from_b)) return Facets::kOfNearer;
    return isSteep(from_b) ? Facets::kOfFirst : Facets::kOfSecond;
  }

 private:
  static bool isSteep(const BeamVector& segment) {
    return square(segment.z) > square(kSteepRise) * squaredNorm(segment);
  }
  static std::size_t index(BeamId beam) { return static_cast<std::size_t>(beam); }
  bool isFree(BeamId beam) const { return beams_.label[index(beam)] == kFreeClass; }
  const ImageBeams& beams_;
  Limits limits_;
};

}  // namespace

void Facets::find(const ImageBeams& beams, const Options& options) {
  to_next.resize(beams.size());
  to_above.resize(beams.size());
  const SegmentTest segments(beams, Limits(static_cast<float>(options.resolution)));
  const BeamNeighbours& n = beams.neighbours;
  parallelRanges(beams.size(), options.threads, [&](std::size_t begin, std::size_t end) {
    const auto beyond = [](const std::vector<BeamId>& side, BeamId beam) {
      return beam == kNoBeam ? kNoBeam : side[static_cast<std::size_t>(beam)];
    };
    for (std::size_t i = begin; i < end; ++i) {
      const auto beam = static_cast<BeamId>(i);
      to_next[i] =
          segments.kindOf(beam, n.next[i], n.previous[i], beyond(n.next, n.next[i]), false);
      to_above[i] =
          segments.kindOf(beam, n.above[i], n.below[i], beyond(n.above, n.above[i]), true);
    }
  });
}

}  // namespace csom::detail
