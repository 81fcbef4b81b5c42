// SPDX-License-Identifier: BSD-3-Clause
// Which voxels of a map are exported, and in which frame.
#include <csom/core/Error.h>
#include <csom/exports/VoxelSelection.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace csom {
namespace {

/// Voxels between two reports of progress.
constexpr std::size_t kReportInterval = std::size_t{1} << 14U;

std::int32_t clampedIndex(double value) {
  return static_cast<std::int32_t>(std::clamp<double>(value, kFirstVoxelIndex, kLastVoxelIndex));
}

double centerOf(double index, double resolution) {
  return (index + 0.5) * resolution;
}

/// The first voxel whose centre is not below `from`. What a quotient says may be off by a rounding;
/// the centres themselves decide.
double firstCenterFrom(double from, double resolution) {
  double index = std::ceil(from / resolution - 0.5);
  while (centerOf(index, resolution) < from) ++index;
  while (centerOf(index - 1, resolution) >= from) --index;
  return index;
}

double lastCenterTo(double to, double resolution) {
  double index = std::floor(to / resolution - 0.5);
  while (centerOf(index, resolution) > to) --index;
  while (centerOf(index + 1, resolution) <= to) ++index;
  return index;
}

}  // namespace

std::optional<VoxelBox> voxelsWithCenterIn(const Grid& grid, const Eigen::AlignedBox3d& box) {
  const double r = grid.resolution();
  // Beyond all indices, where a step of one would be lost in the number.
  const double farthest = centerOf(kLastVoxelIndex + 2.0, r);
  VoxelBox voxels;
  std::int32_t* const first[]{&voxels.min.x, &voxels.min.y, &voxels.min.z};
  std::int32_t* const last[]{&voxels.max.x, &voxels.max.y, &voxels.max.z};
  for (int axis = 0; axis < 3; ++axis) {
    const double from = firstCenterFrom(std::clamp(box.min()[axis], -farthest, farthest), r);
    const double to = lastCenterTo(std::clamp(box.max()[axis], -farthest, farthest), r);
    if (!(from <= to) || from > kLastVoxelIndex || to < kFirstVoxelIndex) return std::nullopt;
    *first[axis] = clampedIndex(from);
    *last[axis] = clampedIndex(to);
  }
  return voxels;
}

VoxelSelection::VoxelSelection(const SemanticMap& map, VoxelFilter filter,
                               const Eigen::Isometry3d& frame, Progress progress)
    : map_(map),
      filter_(std::move(filter)),
      frame_(frame),
      to_map_(frame.inverse()),
      progress_(std::move(progress)),
      known_voxels_(map.knownVoxelCount()) {
  if (filter_.box) box_ = voxelsWithCenterIn(map.grid(), *filter_.box);
}

VoxelSelection VoxelSelection::withFreeVoxels(bool free_voxels) const {
  VoxelSelection selection = *this;
  selection.filter_.free_voxels = free_voxels;
  return selection;
}

VoxelSelection VoxelSelection::withoutBox() const {
  VoxelSelection selection = *this;
  selection.filter_.box.reset();
  return selection;
}

bool VoxelSelection::takes(const VoxelIndex& index, const DirichletVoxel& voxel) const {
  const ClassId k = voxel.mostLikelyClass();
  switch (voxel.state()) {
    case VoxelState::Unknown:
      return false;
    case VoxelState::Free:
      if (!filter_.free_voxels) return false;
      break;
    case VoxelState::Occupied:
      if (!filter_.occupied_voxels) return false;
      if (!filter_.classes.empty() && filter_.classes.count(k) == 0) return false;
      break;
  }
  if (filter_.box) {
    const auto inside = [](std::int32_t v, std::int32_t min, std::int32_t max) {
      return min <= v && v <= max;
    };
    if (!box_ || !inside(index.x, box_->min.x, box_->max.x) ||
        !inside(index.y, box_->min.y, box_->max.y) || !inside(index.z, box_->min.z, box_->max.z))
      return false;
  }
  return voxel.probability(k) >= filter_.min_probability &&
         voxel.evidence() >= filter_.min_evidence;
}

ExportedVoxel VoxelSelection::describe(const DirichletVoxel& voxel, const Eigen::Vector3d& center) {
  const ClassId k = voxel.mostLikelyClass();
  return {center, k, voxel.probability(k), voxel.variance(k), voxel.evidence(), voxel.occupancy()};
}

VoxelBox VoxelSelection::targetsOf(const VoxelIndex& index) const {
  // A little more than half a voxel: which target belongs to which source is isSource()'s decision.
  constexpr double kHalfVoxel = 0.5 + 1e-6;
  const Eigen::Array3d center = (frame_ * map_.grid().center(index)).array() / resolution() - 0.5;
  const Eigen::Array3d reach = frame_.linear().cwiseAbs().rowwise().sum().array() * kHalfVoxel;
  if ((center.abs() + reach).maxCoeff() > kLastVoxelIndex)
    throw ConfigError("the pose of the export moves voxels farther away than a grid of " +
                      toString(resolution()) + " m can address; choose a nearer frame");
  const Eigen::Array3d first = (center - reach).ceil();
  const Eigen::Array3d last = (center + reach).floor();
  return {{clampedIndex(first.x()), clampedIndex(first.y()), clampedIndex(first.z())},
          {clampedIndex(last.x()), clampedIndex(last.y()), clampedIndex(last.z())}};
}

bool VoxelSelection::isSource(const VoxelIndex& index, const Eigen::Vector3d& target_center) const {
  const Eigen::Vector3d point = to_map_ * target_center;
  return map_.grid().isAddressable(point) && map_.grid().voxelAt(point) == index;
}

void VoxelSelection::report(std::size_t seen) const {
  if (progress_ && seen % kReportInterval == 0) progress_(seen, known_voxels_);
}

std::size_t VoxelSelection::count() const {
  std::size_t count = 0;
  forEachSource([&](const VoxelIndex&, const DirichletVoxel&) { ++count; });
  return count;
}

void VoxelSelection::requireVoxels() const {
  if (count() > 0) return;
  const bool filtered = !filter_.classes.empty() || filter_.box || filter_.min_probability > 0 ||
                        filter_.min_evidence > 0;
  if (map_.empty()) throw ConfigError("the map is empty: there is nothing to export");
  throw ConfigError(
      std::string(filtered ? "no voxel of the map passes the filters"
                           : "the map has no occupied voxel") +
      ": there is nothing to export; 'csom info' shows the classes and the extent of a map");
}

void VoxelSelection::requireResampledVoxels() const {
  requireVoxels();
  bool any = false;
  forEachResampled([&](const VoxelIndex&, const ExportedVoxel&) { any = true; });
  if (any) return;
  throw ConfigError(
      "the selection is so small that, in the pose of the export, no voxel of the exported grid "
      "has its centre in it: there is nothing to export; select more, or choose a pose of whole "
      "voxels");
}

std::optional<VoxelBox> VoxelSelection::resampledBounds() const {
  std::optional<VoxelBox> bounds;
  forEachResampled([&](const VoxelIndex& v, const ExportedVoxel&) {
    if (!bounds) bounds = VoxelBox{v, v};
    VoxelIndex& min = bounds->min;
    VoxelIndex& max = bounds->max;
    min = {std::min(min.x, v.x), std::min(min.y, v.y), std::min(min.z, v.z)};
    max = {std::max(max.x, v.x), std::max(max.y, v.y), std::max(max.z, v.z)};
  });
  return bounds;
}

}  // namespace csom
