// SPDX-License-Identifier: BSD-3-Clause
// The surfaces of a map as points to match others with, made when first asked for.
#pragma once

#include <csom/core/SemanticMap.h>
#include <mrpt/maps/CSimplePointsMap.h>

#include <memory>
#include <mutex>
#include <vector>

namespace csom {

/// A point and a class for every occupied voxel, in the map's order. The point is the voxel's
/// centre moved along the normal of the local surface into it: kernels make surfaces several voxels
/// thick, and most of the evidence lies where the surface is.
struct SurfacePoints {
  mrpt::maps::CSimplePointsMap points;
  std::vector<ClassId> classes;
};

std::unique_ptr<const SurfacePoints> makeSurfacePoints(const SemanticMap& map);

/// A cache. get() may be called from several threads at a time; copies start empty.
class SurfacePointsCache {
 public:
  SurfacePointsCache() = default;
  SurfacePointsCache(const SurfacePointsCache&) {}
  SurfacePointsCache& operator=(const SurfacePointsCache&);

  /// The surfaces of `map` as of the last invalidate(), and valid until the next one.
  const SurfacePoints& get(const SemanticMap& map) const;
  void invalidate();

 private:
  mutable std::mutex mutex_;
  mutable std::unique_ptr<const SurfacePoints> points_;
};

}  // namespace csom
