// SPDX-License-Identifier: BSD-3-Clause
// A map seen by a robot that drives on it: a grid of free, occupied and unknown cells.
#include <csom/core/Error.h>
#include <csom/exports/NavigationGrid.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <string>

namespace csom {
namespace {

constexpr std::int64_t kMaxCells = std::int64_t{1} << 28U;

void checkOptions(const NavigationOptions& options) {
  if (!(options.robot_height > 0) || !std::isfinite(options.robot_height))
    throw ConfigError("the robot's height must be greater than 0");
  if (options.band && !(options.band->low < options.band->high))
    throw ConfigError("the obstacle band must begin below its end");
  if (!options.band && options.traversable.empty())
    throw ConfigError(
        "the ground would be an obstacle: name the classes to drive on, or the heights at which "
        "obstacles count",
        {"traversable", "obstacle-band"});
}

}  // namespace

NavigationGrid::NavigationGrid(const VoxelSelection& selection, const NavigationOptions& options)
    : resolution_(selection.resolution()) {
  checkOptions(options);
  const VoxelSelection voxels = selection.withFreeVoxels(true);
  voxels.requireResampledVoxels();
  measure(voxels, options);
  findGround(voxels, options);
  spreadGround(options);
  findObstacles(voxels, options);
  if (count(State::Free) == 0)
    throw ConfigError(
        "no cell would be free: the map has neither free voxels nor ground of the traversable "
        "classes at these heights; map with free_space other than none, or name other "
        "classes and heights");
}

template <class Visitor>
void NavigationGrid::forEachInBand(const VoxelSelection& voxels, const NavigationOptions& options,
                                   Visitor&& visit) {
  voxels.forEachResampled([&](const VoxelIndex& index, const ExportedVoxel& voxel) {
    const double z = voxel.center.z();
    if (!options.band || (options.band->low <= z && z <= options.band->high)) visit(index, voxel);
  });
}

void NavigationGrid::measure(const VoxelSelection& voxels, const NavigationOptions& options) {
  std::int32_t last_x = std::numeric_limits<std::int32_t>::min();
  std::int32_t last_y = last_x;
  first_x_ = first_y_ = std::numeric_limits<std::int32_t>::max();
  forEachInBand(voxels, options, [&](const VoxelIndex& v, const ExportedVoxel&) {
    first_x_ = std::min(first_x_, v.x);
    first_y_ = std::min(first_y_, v.y);
    last_x = std::max(last_x, v.x);
    last_y = std::max(last_y, v.y);
  });
  if (first_x_ > last_x) throw ConfigError("no voxel of the map lies within the obstacle band");
  const std::int64_t width = std::int64_t{last_x} - first_x_ + 1;
  const std::int64_t height = std::int64_t{last_y} - first_y_ + 1;
  if (width * height > kMaxCells)
    throw ConfigError("the grid would have " + std::to_string(width) + " x " +
                          std::to_string(height) + " cells; choose a part of the map",
                      {"box"});
  width_ = static_cast<int>(width);
  height_ = static_cast<int>(height);
  cells_.resize(static_cast<std::size_t>(width * height));
}

void NavigationGrid::findGround(const VoxelSelection& voxels, const NavigationOptions& options) {
  forEachInBand(voxels, options, [&](const VoxelIndex& v, const ExportedVoxel& voxel) {
    Cell& cell = cellOf(v);
    if (voxel.class_id == kFreeClass || v.z >= cell.ground) return;
    cell.ground = v.z;
    cell.ground_class = voxel.class_id;
  });
  for (Cell& cell : cells_) {
    cell.own_ground = cell.ground != kNone && options.traversable.count(cell.ground_class) != 0;
    if (!cell.own_ground) cell.ground = kNone;
  }
}

void NavigationGrid::spreadGround(const NavigationOptions& options) {
  // Breadth first from all columns with a ground of their own.
  std::deque<std::size_t> border;
  for (std::size_t i = 0; i < cells_.size(); ++i)
    if (cells_[i].own_ground) border.push_back(i);
  if (border.empty()) {
    if (!options.band)
      throw ConfigError(
          "no column of the map stands on a traversable class; name others, or the heights at "
          "which "
          "obstacles count",
          {"traversable", "obstacle-band"});
    // The last voxel below the band.
    const double below = std::ceil(options.band->low / resolution_ - 0.5) - 1;
    const auto ground =
        static_cast<std::int32_t>(std::clamp<double>(below, -kMaxVoxelIndex - 2, kMaxVoxelIndex));
    for (Cell& cell : cells_) cell.ground = ground;
  }
  const auto row = static_cast<std::size_t>(width_);
  while (!border.empty()) {
    const std::size_t at = border.front();
    border.pop_front();
    const auto spreadTo = [&](bool inside, std::size_t to) {
      if (!inside || cells_[to].ground != kNone) return;
      cells_[to].ground = cells_[at].ground;
      border.push_back(to);
    };
    spreadTo(at % row > 0, at - 1);
    spreadTo(at % row + 1 < row, at + 1);
    spreadTo(at >= row, at - row);
    spreadTo(at + row < cells_.size(), at + row);
  }
}

void NavigationGrid::findObstacles(const VoxelSelection& voxels, const NavigationOptions& options) {
  // A voxel at the robot's height touches it not; rounding must not decide otherwise.
  const double height = options.robot_height / resolution_ - 1e-6;
  forEachInBand(voxels, options, [&](const VoxelIndex& v, const ExportedVoxel& voxel) {
    Cell& cell = cellOf(v);
    if (v.z <= cell.ground || v.z - cell.ground - 1 >= height) return;
    if (voxel.class_id == kFreeClass) {
      cell.seen_free = true;
    } else if (options.traversable.count(voxel.class_id) == 0 && v.z < cell.obstacle) {
      cell.obstacle = v.z;
      cell.obstacle_class = voxel.class_id;
    }
  });
}

Eigen::Vector2d NavigationGrid::origin() const {
  return {first_x_ * resolution_, first_y_ * resolution_};
}

NavigationGrid::State NavigationGrid::state(int x, int y) const {
  const Cell& c = cell(x, y);
  if (c.obstacle != kNone) return State::Occupied;
  return c.own_ground || c.seen_free ? State::Free : State::Unknown;
}

std::optional<ClassId> NavigationGrid::classAt(int x, int y) const {
  const Cell& c = cell(x, y);
  switch (state(x, y)) {
    case State::Unknown:
      return std::nullopt;
    case State::Occupied:
      return c.obstacle_class;
    case State::Free:
      return c.own_ground ? c.ground_class : kFreeClass;
  }
  return std::nullopt;
}

std::size_t NavigationGrid::count(State wanted) const {
  std::size_t count = 0;
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) count += state(x, y) == wanted ? 1 : 0;
  return count;
}

NavigationGrid::Cell& NavigationGrid::cellOf(const VoxelIndex& v) {
  return cells_[static_cast<std::size_t>(v.y - first_y_) * static_cast<std::size_t>(width_) +
                static_cast<std::size_t>(v.x - first_x_)];
}

const NavigationGrid::Cell& NavigationGrid::cell(int x, int y) const {
  return cells_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                static_cast<std::size_t>(x)];
}

}  // namespace csom
