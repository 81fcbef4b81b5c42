// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Kernel.h>
#include <csom/core/LocalSurface.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "BlockWindow.h"
#include "ChunkTasks.h"
#include "NearbyBlocks.h"
#include "Parallel.h"
#include "PointColumns.h"

namespace csom {

namespace {

using Shape = LocalSurface::Shape;

/// The neighbour whose distance tells the spacing: beyond the next two of a row of hits.
constexpr std::size_t kSpacingNeighbour = 3;
/// Kernel of the covariance, in units of the spacing of all neighbours.
constexpr double kCovarianceReach = 2.5;
/// λ0/λ1 up to which hits lie on a plane.
constexpr double kFlat = 0.5;
/// (√λ1 − √λ0)/√λ2 from which hits cover a plane to all sides rather than line up on it.
constexpr double kCovered = 0.5;
/// Neighbouring voxels must hear of each other's hits, however dense those are.
constexpr double kLeastSpacing = 1.1;
constexpr double kScatteredReach = 0.85;
/// Spacing of hits that count as dense, in max(ds, r): cells of down-sampling are not all filled.
constexpr double kDense = 1.3;
/// Lengths beyond these cost more than the gaps are worth, in voxels.
constexpr double kWidestSpacing = 16;
constexpr double kLongestKernel = 24;
/// Of a row of blocks so many points are looked at: a million at one place cost no more than a wall.
constexpr std::uint32_t kMostInRow = 256;

/// A hit seen from another; in voxels.
struct Neighbour {
  float squared;
  Eigen::Vector3f offset;
  std::uint32_t point;

  friend bool operator<(const Neighbour& a, const Neighbour& b) {
    return a.squared != b.squared ? a.squared < b.squared : a.point < b.point;
  }
};

class SurfaceSearch {
 public:
  SurfaceSearch(const PreparedScan& scan, const Options& options)
      : scan_(scan),
        options_(options),
        points_(scan),
        rows_(scan),
        block_side_(1 << (scan.block_depth - 1)),
        blocks_per_chunk_(kChunkSide / block_side_),
        spacing_limit_(std::min(std::max(options.ds_resolution / options.resolution, 1.0),
                                kWidestSpacing)),
        plane_spacing_limit_(std::min(options.surface_gap * spacing_limit_, kWidestSpacing)),
        radius_(static_cast<float>(1.5 * plane_spacing_limit_)),
        reach_(detail::NearbyBlocks::reachOf(radius_, block_side_, 0)) {}

  std::vector<LocalSurface> run() {
    surfaces_.resize(scan_.points.size());
    std::vector<FilledBlock> blocks;
    for (std::size_t b = 0; b < scan_.blocks.size(); ++b)
      blocks.push_back({scan_.blocks[b], static_cast<std::int32_t>(b)});
    const auto tasks = detail::groupByChunk(blocks, scan_.block_depth);
    const auto runs = detail::runsOf(tasks);
    detail::parallelRanges(
        runs.size() - 1, options_.threads, [&](std::size_t begin, std::size_t end) {
          Scratch scratch{{}, {block_side_, reach_, 0}, {}, {}};
          for (std::size_t run = begin; run < end; ++run) {
            const BlockIndex corner = cornerOf(tasks[runs[run]].chunk);
            const BlockIndex last = cornerOf(tasks[runs[run + 1] - 1].chunk);
            scratch.window.moveTo(rows_, corner, last.x - corner.x + blocks_per_chunk_,
                                  blocks_per_chunk_, reach_);
            for (std::size_t i = tasks[runs[run]].begin; i < tasks[runs[run + 1] - 1].end; ++i)
              describe(blocks[i], corner, scratch);
          }
        });
    return std::move(surfaces_);
  }

 private:
  struct Scratch {
    detail::BlockWindow window;
    detail::NearbyBlocks nearby;
    std::vector<detail::PointRange> ranges;
    std::vector<Neighbour> neighbours;
  };

  BlockIndex cornerOf(const ChunkIndex& chunk) const {
    return {chunk.x * blocks_per_chunk_, chunk.y * blocks_per_chunk_, chunk.z * blocks_per_chunk_};
  }

  bool isFree(std::size_t point) const {
    if (scan_.scores.empty()) return points_.label[point] == kFreeClass;
    const auto classes = static_cast<std::size_t>(options_.number_of_classes);
    return scan_.scores[point * classes + kFreeClass] > 0.5F;
  }

  /// `corner` is that of the window.
  void describe(const FilledBlock& block, const BlockIndex& corner, Scratch& scratch) {
    const BlockIndex in_window{block.index.x - corner.x, block.index.y - corner.y,
                               block.index.z - corner.z};
    const auto b = static_cast<std::size_t>(block.observed);
    for (std::uint32_t p = scan_.block_begin[b]; p < scan_.block_begin[b + 1]; ++p) {
      LocalSurface& surface = surfaces_[p];
      if (isFree(p)) {
        surface.shape = Shape::Free;
        surface.length = static_cast<float>(options_.kernelLengthMin() / options_.resolution);
        continue;
      }
      findNeighbours(p, in_window, scratch);
      surface = surfaceOf(scratch.neighbours);
    }
  }

  /// The nearest hits, nearest first; fewer than asked for if there are no more within radius_.
  void findNeighbours(std::uint32_t p, const BlockIndex& block, Scratch& scratch) const {
    const auto wanted = static_cast<std::size_t>(options_.surface_neighbours);
    for (float radius = std::min(2.0F, radius_);; radius = std::min(2 * radius, radius_)) {
      detail::listRanges(scratch.window, block, scratch.nearby.within(radius), scratch.ranges);
      scratch.neighbours.clear();
      for (const detail::PointRange& range : scratch.ranges)
        addNeighbours(p, range, radius * radius, scratch.neighbours);
      if (scratch.neighbours.size() >= wanted || radius == radius_) break;
    }
    std::vector<Neighbour>& found = scratch.neighbours;
    const auto end = found.begin() + static_cast<std::ptrdiff_t>(std::min(wanted, found.size()));
    std::partial_sort(found.begin(), end, found.end());
    found.erase(end, found.end());
  }

  void addNeighbours(std::uint32_t p, const detail::PointRange& range, float limit,
                     std::vector<Neighbour>& found) const {
    const std::uint32_t step = (range.last - range.first + kMostInRow - 1) / kMostInRow;
    for (std::uint32_t q = range.first; q < range.last; q += step) {
      const Eigen::Vector3f offset(difference(points_.x, q, p), difference(points_.y, q, p),
                                   difference(points_.z, q, p));
      const float squared = offset.squaredNorm();
      if (squared < limit && q != p && !isFree(q)) found.push_back({squared, offset, q});
    }
  }

  static float difference(const std::vector<detail::FixedPoint>& axis, std::uint32_t a,
                          std::uint32_t b) {
    constexpr float kVoxels = 1.0F / detail::kFixedPointVoxel;
    return static_cast<float>(static_cast<std::int32_t>(axis[a] - axis[b])) * kVoxels;
  }

  LocalSurface surfaceOf(const std::vector<Neighbour>& neighbours) const {
    LocalSurface surface;
    const std::size_t size = neighbours.size();
    if (size < kSpacingNeighbour) {
      setLength(radius_, kLeastSpacing, surface);
      return surface;
    }
    // Each hit stands for an area s², so a disc that reaches to the n-th neighbour holds n + ½.
    const auto spacingTo = [&](std::size_t n) {
      return std::sqrt(static_cast<double>(neighbours[n - 1].squared) * M_PI /
                       (static_cast<double>(n) + 0.5));
    };
    const double spacing = spacingTo(kSpacingNeighbour);
    const Eigen::Matrix3d covariance =
        covarianceOf(neighbours, kCovarianceReach * spacingTo(size));
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    const Eigen::Vector3d lambda = solver.eigenvalues().cwiseMax(0.0);
    if (!options_.surface_planes || !(lambda[0] < kFlat * lambda[1])) {
      setLength(spacing, spacing_limit_, surface);
      return surface;
    }
    surface.shape = Shape::Plane;
    surface.normal = solver.eigenvectors().col(0).cast<float>();
    surface.half_thickness = static_cast<float>(options_.surface_thickness) *
                             (std::abs(surface.normal.x()) + std::abs(surface.normal.y()) +
                              std::abs(surface.normal.z())) /
                             2;
    const bool covered =
        std::sqrt(lambda[1]) - std::sqrt(lambda[0]) >= kCovered * std::sqrt(lambda[2]);
    setLength(spacing, covered ? plane_spacing_limit_ : spacing_limit_, surface);
    return surface;
  }

  /// Of the hit itself, which is at 0, and its neighbours.
  static Eigen::Matrix3d covarianceOf(const std::vector<Neighbour>& neighbours, double length) {
    double mass = 1;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    for (const Neighbour& n : neighbours) {
      const double t = std::sqrt(static_cast<double>(n.squared)) / length;
      const double weight = t < 1 ? static_cast<double>(sparseKernel(static_cast<float>(t))) : 0;
      const Eigen::Vector3d offset = n.offset.cast<double>();
      mass += weight;
      sum += weight * offset;
      squares += weight * offset * offset.transpose();
    }
    const Eigen::Vector3d mean = sum / mass;
    return squares / mass - mean * mean.transpose();
  }

  /// `spacing` of the hits, and the widest that a kernel spans.
  void setLength(double spacing, double limit, LocalSurface& surface) const {
    const double expected = kDense * spacing_limit_ / spacing;
    surface.density = static_cast<float>(std::min(1.0, expected * expected));
    spacing = std::min(spacing, limit);
    const double length = options_.surface_reach * std::max(spacing, kLeastSpacing) *
                          (surface.shape == Shape::Plane ? 1 : kScatteredReach);
    surface.length = static_cast<float>(std::min(length, kLongestKernel));
  }

  const PreparedScan& scan_;
  const Options& options_;
  detail::PointColumns points_;
  detail::BlockRows rows_;
  int block_side_;  ///< voxels
  int blocks_per_chunk_;
  double spacing_limit_;        ///< voxels
  double plane_spacing_limit_;  ///< voxels
  float radius_;                ///< within which neighbours are looked for [voxels]
  int reach_;                   ///< the same in blocks
  std::vector<LocalSurface> surfaces_;
};

}  // namespace

std::vector<LocalSurface> localSurfaces(const PreparedScan& scan, const Options& options) {
  if (scan.blocks.empty()) return {};
  return SurfaceSearch(scan, options).run();
}

}  // namespace csom
