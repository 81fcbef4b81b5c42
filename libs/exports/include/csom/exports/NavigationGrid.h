// SPDX-License-Identifier: BSD-3-Clause
// A map seen by a robot that drives on it: a grid of free, occupied and unknown cells.
#pragma once

#include <csom/exports/VoxelSelection.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

namespace csom {

struct NavigationOptions {
  /// Only voxels whose centres lie between these heights count [m, frame of the export].
  struct Band {
    double low;
    double high;
  };
  std::optional<Band> band;
  /// Voxels that begin this far above the ground, or farther, are no obstacles [m].
  double robot_height = 1;
  /// Classes to drive on: never obstacles.
  std::set<ClassId> traversable;
};

/// The columns of a map, one cell each. z of the export's frame points up.
///
/// The *ground* of a column is its lowest voxel, if that is traversable; that of the nearest such
/// column otherwise; the lower end of the band if there are no traversable voxels at all. An
/// *obstacle* is an occupied voxel of another class above the ground and within the robot's height.
/// A cell is occupied if there is an obstacle; else free if its own ground was seen or a voxel
/// above it, within the robot's height, is free; else unknown.
class NavigationGrid {
 public:
  enum class State : std::uint8_t { Unknown, Free, Occupied };

  /// Takes the free voxels along, whatever the selection says. Throws ConfigError if the options
  /// make no sense or do not fit the map, if no cell would be free, or if there would be more than
  /// 2^28 cells.
  NavigationGrid(const VoxelSelection& voxels, const NavigationOptions& options);

  int width() const { return width_; }    ///< cells along x
  int height() const { return height_; }  ///< cells along y
  double resolution() const { return resolution_; }
  /// Lower corner of cell (0, 0) [m].
  Eigen::Vector2d origin() const;

  /// Requires 0 ≤ x < width(), 0 ≤ y < height().
  State state(int x, int y) const;
  /// Class of the lowest obstacle, or of the ground; kFreeClass where the ground was not seen.
  /// Nothing if the cell is unknown.
  std::optional<ClassId> classAt(int x, int y) const;
  std::size_t count(State state) const;

 private:
  static constexpr std::int32_t kNone = INT32_MAX;

  /// Heights are those of voxels in the grid of the export.
  struct Cell {
    std::int32_t ground = kNone;
    std::int32_t obstacle = kNone;
    ClassId ground_class = kFreeClass;
    ClassId obstacle_class = kFreeClass;
    bool own_ground = false;
    bool seen_free = false;
  };

  template <class Visitor>
  void forEachInBand(const VoxelSelection& voxels, const NavigationOptions& options,
                     Visitor&& visit);
  void measure(const VoxelSelection& voxels, const NavigationOptions& options);
  void findGround(const VoxelSelection& voxels, const NavigationOptions& options);
  void spreadGround(const NavigationOptions& options);
  void findObstacles(const VoxelSelection& voxels, const NavigationOptions& options);

  Cell& cellOf(const VoxelIndex& v);
  const Cell& cell(int x, int y) const;

  double resolution_;
  std::int32_t first_x_ = 0;
  std::int32_t first_y_ = 0;
  int width_ = 0;
  int height_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace csom
