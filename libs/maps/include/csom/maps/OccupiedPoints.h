// SPDX-License-Identifier: BSD-3-Clause
// The occupied voxels of a map as a points map of MRPT, made when first asked for.
#pragma once

#include <csom/core/SemanticMap.h>
#include <mrpt/maps/CSimplePointsMap.h>

#include <memory>
#include <mutex>

namespace csom {

/// A cache. get() may be called from several threads at a time; copies start empty.
class OccupiedPoints {
 public:
  OccupiedPoints() = default;
  OccupiedPoints(const OccupiedPoints&) {}
  OccupiedPoints& operator=(const OccupiedPoints&);

  /// Centres of the occupied voxels of `map`, in its order, as of the last invalidate().
  const mrpt::maps::CSimplePointsMap& get(const SemanticMap& map) const;
  void invalidate();

 private:
  mutable std::mutex mutex_;
  mutable std::unique_ptr<mrpt::maps::CSimplePointsMap> points_;
};

}  // namespace csom
