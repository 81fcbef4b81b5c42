// SPDX-License-Identifier: BSD-3-Clause
#include "surface/LocalSurface.h"

#include <csom/core/Kernel.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "inference/BlockWindow.h"
#include "inference/ChunkTasks.h"
#include "inference/FixedPointLanes.h"
#include "inference/NearbyBlocks.h"
#include "inference/PointColumns.h"
#include "surface/NearestHits.h"
#include "surface/PrincipalAxes.h"
#include "util/Parallel.h"

namespace csom::detail {

namespace {

using Shape = LocalSurface::Shape;

/// The neighbour whose distance tells the spacing: beyond the next two of a row of hits.
constexpr std::size_t kSpacingNeighbour = 3;
/// Kernel of the covariance, in units of the spacing of all neighbours.
constexpr float kCovarianceReach = 2.5F;
/// λ0/λ1 up to which hits lie on a plane.
constexpr float kFlat = 0.5F;
/// (√λ1 − √λ0)/√λ2 from which hits cover a plane to all sides rather than line up on it.
constexpr float kCovered = 0.5F;
/// By so much a plane is thicker than the way to the centre that it must reach [voxels].
constexpr float kCenterRounding = 1e-4F;
/// However dense hits are, their kernels reach neighbouring voxels [voxels].
constexpr double kMinSpacing = 1.1;
constexpr double kScatteredReach = 0.85;
/// Spacing of hits that count as dense, in max(ds, r): cells of down-sampling are not all filled.
constexpr double kDense = 1.3;
/// Lengths beyond these cost more than the gaps are worth, in voxels.
constexpr double kMaxSpacing = 16;
constexpr double kMaxKernelLength = 24;
/// Where the nearest hits are looked for first [voxels], and how much farther than those of the
/// hit before. Both change the time alone.
constexpr float kFirstRadius = 2;
constexpr float kRadiusGrowth = 1.2F;
constexpr float kMinRadius = 0.5F;
/// Of a row of blocks so many points are looked at: a million at one place cost no more than a
/// wall.
constexpr std::uint32_t kMaxPointsOfRow = 256;

/// Offers the hits of a range to hit p.
CSOM_EVERY_PROCESSOR
void offerNear(const PointColumns& points, const PointRange& range, std::uint32_t p,
               NearestHits& nearest) {
  constexpr float kVoxels = 1.0F / kUnits;
  for (std::uint32_t first = range.first; first < range.last; first += kLanes) {
    const Lanes dx = toFloat(load(points.x.data() + first) - points.x[p]) * kVoxels;
    const Lanes dy = toFloat(load(points.y.data() + first) - points.y[p]) * kVoxels;
    const Lanes dz = toFloat(load(points.z.data() + first) - points.z[p]) * kVoxels;
    const Lanes squared = dx * dx + dy * dy + dz * dz;
    const IntLanes near = squared < nearest.limitSquared();
    if (isNone(near)) continue;
    const auto count = std::min<std::uint32_t>(kLanes, range.last - first);
    std::array<std::uint32_t, kLanes> lanes;  // free of branches: which are near cannot be foreseen
    std::size_t found = 0;
    for (std::uint32_t lane = 0; lane < count; ++lane) {
      lanes[found] = lane;
      found += near[lane] != 0 ? 1 : 0;
    }
    for (std::size_t i = 0; i < found; ++i) {
      const std::uint32_t q = first + lanes[i];
      const float distance = squared[lanes[i]];
      if (distance < nearest.limitSquared() && q != p) nearest.offer(distance, q);
    }
  }
}

/// Neighbourhoods of up to eight hits, a lane each, that wait for their surfaces.
struct Neighbourhoods {
  using OfLanes = std::array<float, kLanes>;

  std::size_t size = 0;
  std::array<std::uint32_t, kLanes> point{};
  OfLanes spacing{};         ///< s, in voxels
  OfLanes inverse_length{};  ///< of the kernel of the covariance
  // The nearest hits of each, nearest first: their offsets [voxels] and squared distances. Those of
  // a lane that has fewer are out of reach.
  std::size_t neighbours = 0;
  std::array<OfLanes, NearestHits::kMax> x{}, y{}, z{}, squared{};
};

/// Covariances of the hits and the nearest to them.
CSOM_EVERY_PROCESSOR
void computeCovariances(const Neighbourhoods& waiting, LaneCovariance& covariance) {
  const Lanes inverse_length = load(waiting.inverse_length.data());
  Lanes mass = Lanes{} + 1;
  Lanes x{}, y{}, z{}, xx{}, yy{}, zz{}, xy{}, xz{}, yz{};
  for (std::size_t n = 0; n < waiting.neighbours; ++n) {
    const Lanes t = squareRoot(load(waiting.squared[n].data())) * inverse_length;
    const Lanes weight = sparseKernel(t);
    const Lanes dx = load(waiting.x[n].data());
    const Lanes dy = load(waiting.y[n].data());
    const Lanes dz = load(waiting.z[n].data());
    const Lanes wx = weight * dx;
    const Lanes wy = weight * dy;
    const Lanes wz = weight * dz;
    mass += weight;
    x += wx;
    y += wy;
    z += wz;
    xx += wx * dx;
    yy += wy * dy;
    zz += wz * dz;
    xy += wx * dy;
    xz += wx * dz;
    yz += wy * dz;
  }
  const Lanes mx = x / mass;
  const Lanes my = y / mass;
  const Lanes mz = z / mass;
  covariance.xx = xx / mass - mx * mx;
  covariance.yy = yy / mass - my * my;
  covariance.zz = zz / mass - mz * mz;
  covariance.xy = xy / mass - mx * my;
  covariance.xz = xz / mass - mx * mz;
  covariance.yz = yz / mass - my * mz;
}

/// A scan without its free samples.
struct Hits {
  Hits(const PreparedScan& all, const Options& options) {
    const auto classes = static_cast<std::size_t>(options.number_of_classes);
    const auto isFree = [&](std::size_t p) {
      return all.scores.empty() ? all.points[p].label == kFreeClass
                                : all.scores[p * classes + kFreeClass] > 0.5F;
    };
    scan.layout = all.layout;
    for (std::size_t b = 0; b < all.blocks.size(); ++b) {
      const std::size_t before = point.size();
      for (std::uint32_t p = all.block_begin[b]; p < all.block_begin[b + 1]; ++p)
        if (!isFree(p)) point.push_back(p);
      if (point.size() == before) continue;
      scan.blocks.push_back(all.blocks[b]);
      scan.block_begin.push_back(static_cast<std::uint32_t>(before));
    }
    scan.block_begin.push_back(static_cast<std::uint32_t>(point.size()));
    scan.points.reserve(point.size());
    for (const std::uint32_t p : point) scan.points.push_back(all.points[p]);
  }

  PreparedScan scan;
  std::vector<std::uint32_t> point;  ///< which of all points each hit is
};

/// The surfaces of a scan without free samples.
class SurfaceSearch {
 public:
  SurfaceSearch(const PreparedScan& scan, const Options& options)
      : scan_(scan),
        options_(options),
        points_(scan),
        rows_(scan),
        spacing_limit_(
            std::min(std::max(options.scan.ds_resolution / options.resolution, 1.0), kMaxSpacing)),
        plane_spacing_limit_(std::min(options.surface.gap * spacing_limit_, kMaxSpacing)),
        radius_(static_cast<float>(1.5 * plane_spacing_limit_)),
        reach_(NearbyBlocks::reachOf(radius_, scan.layout.side(), 0)) {}

  std::vector<LocalSurface> run() {
    surfaces_.resize(scan_.points.size());
    std::vector<std::uint32_t> blocks(scan_.blocks.size());
    std::iota(blocks.begin(), blocks.end(), 0U);
    const auto tasks = groupByChunk(
        blocks, [&](std::uint32_t b) { return scan_.layout.chunkOf(scan_.blocks[b]); });
    const auto runs = findRuns(tasks);
    parallelRanges(runs.size() - 1, options_.threads, [&](std::size_t begin, std::size_t end) {
      Scratch scratch(scan_.layout.side(), reach_);
      for (std::size_t run = begin; run < end; ++run) {
        scratch.radius = std::min(kFirstRadius, radius_);
        const BlockIndex corner = scan_.layout.firstBlock(tasks[runs[run]].chunk);
        const BlockIndex last = scan_.layout.firstBlock(tasks[runs[run + 1] - 1].chunk);
        scratch.window.moveTo(rows_, corner, last.x - corner.x + scan_.layout.blocksPerChunk(),
                              scan_.layout.blocksPerChunk(), reach_);
        for (std::size_t i = tasks[runs[run]].begin; i < tasks[runs[run + 1] - 1].end; ++i)
          describe(blocks[i], corner, scratch);
        setSurfaces(scratch.waiting);
      }
    });
    return std::move(surfaces_);
  }

 private:
  struct Scratch {
    Scratch(int block_side, int reach) : nearby(block_side, reach, 0) {}
    BlockWindow window;
    NearbyBlocks nearby;
    std::vector<PointRange> ranges;
    NearestHits nearest;
    float radius = 0;  ///< where the nearest hits of the next hit may lie
    Neighbourhoods waiting;
  };

  /// `corner` is that of the window.
  void describe(std::uint32_t b, const BlockIndex& corner, Scratch& scratch) {
    const BlockIndex& block = scan_.blocks[b];
    const BlockIndex in_window{block.x - corner.x, block.y - corner.y, block.z - corner.z};
    for (std::uint32_t p = scan_.block_begin[b]; p < scan_.block_begin[b + 1]; ++p) {
      findNearest(p, in_window, scratch);
      describeNeighbourhood(p, scratch.nearest, scratch.waiting);
      if (scratch.waiting.size == kLanes) setSurfaces(scratch.waiting);
    }
  }

  /// Finds the nearest hits, as many as are wanted or all within radius_.
  void findNearest(std::uint32_t p, const BlockIndex& block, Scratch& scratch) const {
    const auto wanted = static_cast<std::size_t>(options_.surface.neighbours);
    NearestHits& nearest = scratch.nearest;
    float radius = scratch.radius;
    for (;; radius = std::min(2 * radius, radius_)) {
      listRanges(scratch.window, block, scratch.nearby.within(radius), scratch.ranges);
      nearest.reset(wanted, radius * radius);
      for (const PointRange& range : scratch.ranges) {
        if (range.last - range.first <= kMaxPointsOfRow) {
          offerNear(points_, range, p, nearest);
          continue;
        }
        const std::uint32_t step =
            (range.last - range.first + kMaxPointsOfRow - 1) / kMaxPointsOfRow;
        for (std::uint32_t q = range.first; q < range.last; q += step)
          offerNear(points_, {q, q + 1}, p, nearest);
      }
      if (nearest.complete() || radius == radius_) break;
    }
    scratch.radius =
        nearest.complete()
            ? std::clamp(kRadiusGrowth * std::sqrt(nearest.limitSquared()), kMinRadius, radius_)
            : radius_;
  }

  /// From a hit to the centre of the voxel that it lies in [voxels].
  Eigen::Vector3f toVoxelCenter(std::uint32_t p) const {
    const auto along = [](FixedPoint coordinate) {
      const FixedPoint within = coordinate % kFixedPointVoxel;
      return 0.5F - static_cast<float>(within) / kFixedPointVoxel;
    };
    return {along(points_.x[p]), along(points_.y[p]), along(points_.z[p])};
  }

  /// From one point to another along an axis [voxels].
  static float difference(const std::vector<FixedPoint>& axis, std::uint32_t a, std::uint32_t b) {
    constexpr float kVoxels = 1.0F / kFixedPointVoxel;
    return static_cast<float>(static_cast<std::int32_t>(axis[a] - axis[b])) * kVoxels;
  }

  void describeNeighbourhood(std::uint32_t p, const NearestHits& nearest, Neighbourhoods& waiting) {
    if (nearest.size() < kSpacingNeighbour) {
      setLength(radius_, kMinSpacing, surfaces_[p]);
      return;
    }
    // Each hit stands for an area s², so a disc that reaches to the n-th neighbour holds n + ½.
    const auto spacingTo = [&](std::size_t n) {
      return std::sqrt(nearest.squared(n - 1) * static_cast<float>(M_PI) /
                       (static_cast<float>(n) + 0.5F));
    };
    const std::size_t lane = waiting.size++;
    waiting.point[lane] = p;
    waiting.spacing[lane] = spacingTo(kSpacingNeighbour);
    waiting.inverse_length[lane] = 1 / (kCovarianceReach * spacingTo(nearest.size()));
    for (; waiting.neighbours < nearest.size(); ++waiting.neighbours)
      waiting.squared[waiting.neighbours].fill(std::numeric_limits<float>::max());
    for (std::size_t n = 0; n < nearest.size(); ++n) {
      waiting.x[n][lane] = difference(points_.x, nearest.point(n), p);
      waiting.y[n][lane] = difference(points_.y, nearest.point(n), p);
      waiting.z[n][lane] = difference(points_.z, nearest.point(n), p);
      waiting.squared[n][lane] = nearest.squared(n);
    }
  }

  /// The surfaces of all hits that wait.
  void setSurfaces(Neighbourhoods& waiting) {
    LaneCovariance covariance;
    computeCovariances(waiting, covariance);
    const PrincipalAxes axes = principalAxes(covariance);
    for (std::size_t lane = 0; lane < waiting.size; ++lane) {
      const auto variance = [&](std::size_t i) { return axes.variance[i][lane]; };
      const Eigen::Vector3f normal(axes.normal[0][lane], axes.normal[1][lane],
                                   axes.normal[2][lane]);
      LocalSurface& surface = surfaces_[waiting.point[lane]];
      if (!options_.surface.planes || !(variance(0) < kFlat * variance(1))) {
        setLength(waiting.spacing[lane], spacing_limit_, surface);
        continue;
      }
      surface.shape = Shape::Plane;
      const float towards_center = normal.dot(toVoxelCenter(waiting.point[lane]));
      surface.normal = towards_center < 0 ? Eigen::Vector3f(-normal) : normal;
      surface.half_thickness =
          static_cast<float>(options_.surface.thickness) * normal.lpNorm<1>() / 2;
      surface.half_thickness_of_own_side =
          std::max(surface.half_thickness, std::abs(towards_center) + kCenterRounding);
      const bool covered =
          std::sqrt(variance(1)) - std::sqrt(variance(0)) >= kCovered * std::sqrt(variance(2));
      setLength(waiting.spacing[lane], covered ? plane_spacing_limit_ : spacing_limit_, surface);
    }
    waiting.size = 0;
    waiting.neighbours = 0;
  }

  /// `spacing` of the hits, and the widest that a kernel spans.
  void setLength(double spacing, double limit, LocalSurface& surface) const {
    const double expected = kDense * spacing_limit_ / spacing;
    surface.density = static_cast<float>(std::min(1.0, expected * expected));
    spacing = std::min(spacing, limit);
    const double length = options_.surface.reach * std::max(spacing, kMinSpacing) *
                          (surface.shape == Shape::Plane ? 1 : kScatteredReach);
    surface.length = static_cast<float>(std::min(length, kMaxKernelLength));
  }

  const PreparedScan& scan_;
  const Options& options_;
  PointColumns points_;
  BlockRows rows_;
  double spacing_limit_;        ///< voxels
  double plane_spacing_limit_;  ///< voxels
  float radius_;                ///< within which neighbours are looked for [voxels]
  int reach_;                   ///< the same in blocks
  std::vector<LocalSurface> surfaces_;
};

}  // namespace

std::vector<LocalSurface> computeLocalSurfaces(const PreparedScan& scan, const Options& options) {
  LocalSurface free;
  free.shape = Shape::Free;
  free.length = static_cast<float>(options.kernelLengthMin() / options.resolution);
  std::vector<LocalSurface> surfaces(scan.points.size(), free);
  const Hits hits(scan, options);
  if (hits.point.empty()) return surfaces;
  const std::vector<LocalSurface> of_hits = SurfaceSearch(hits.scan, options).run();
  for (std::size_t i = 0; i < of_hits.size(); ++i) surfaces[hits.point[i]] = of_hits[i];
  return surfaces;
}

}  // namespace csom::detail
