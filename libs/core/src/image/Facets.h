// SPDX-License-Identifier: BSD-3-Clause
// Which segments between adjacent beams are surface.
#pragma once

#include <csom/core/Options.h>

#include <cstdint>
#include <vector>

#include "image/ImageBeams.h"

namespace csom::detail {

/// A segment between the ends a and b of adjacent beams is surface
///
/// - if it is shorter than 1.5 voxels, or
/// - if it is no longer than 20 m and continues the segment before or after it in its row or
///   column: that one is within 30° of the same direction and, for segments of 5 voxels and more,
///   its line passes the other end at less than 0.2 m × the sine of the angle between segment and
///   beam. So much is explained by errors of ranges: the more a beam grazes a surface, the less.
///
/// Between different classes a longer segment must be across rows, lie flat (rise less than 0.08 of
/// its length) and continue one of the two within 0.4 voxels: so a kerb or a car on the road keeps
/// its border, and road goes over into pavement.
///
/// Each half has the class of its end. But where the next segment beyond one end alone rises more
/// than half of its length, all of it has the class of the other: the road that leads to a wall is
/// road.
///
/// Beams that ended in class 0, free, have no surface.
struct Facets {
  enum Kind : std::uint8_t {
    kNone,  ///< no surface
    kOfNearer,
    kOfFirst,  ///< all of it has the class of the first end
    kOfSecond
  };
  void find(const ImageBeams& beams, const Options& options);

  std::vector<Kind> to_next;  ///< of each beam
  std::vector<Kind> to_above;
};

}  // namespace csom::detail
