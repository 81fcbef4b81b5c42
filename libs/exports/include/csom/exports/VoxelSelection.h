// SPDX-License-Identifier: BSD-3-Clause
// Which voxels of a map are exported, and in which frame.
#pragma once

#include <csom/core/SemanticMap.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <utility>

namespace csom {

/// The voxels whose centres, as Grid::center() computes them, lie in a box of the map frame or on
/// its faces; nothing if there are none.
std::optional<VoxelBox> voxelsWithCenterIn(const Grid& grid, const Eigen::AlignedBox3d& box);

/// All conditions must hold.
struct VoxelFilter {
  bool occupied_voxels = true;
  bool free_voxels = false;
  /// Most likely classes of the occupied voxels to be exported; empty: all.
  std::set<ClassId> classes;
  std::optional<Eigen::AlignedBox3d> box;  ///< holds the voxel's centre; map frame [m]
  double min_probability = 0;              ///< of the most likely class
  double min_evidence = 0;                 ///< of all classes together
};

/// What exports say about a voxel.
struct ExportedVoxel {
  Eigen::Vector3d center;  ///< in the frame of the export [m]
  ClassId class_id;        ///< the most likely one; kFreeClass if free
  double probability;      ///< of that class
  double variance;         ///< of that class's probability
  double evidence;         ///< of all classes together
  double occupancy;        ///< 1 − probability of class 0
};

/// A view of a map, which must outlive it. Holds no voxels: each pass walks through the map again,
/// so that an export needs no second map's memory. Thread-safety as SemanticMap's.
class VoxelSelection {
 public:
  /// Told now and then how many of the map's known voxels a pass has seen.
  using Progress = std::function<void(std::size_t seen, std::size_t known)>;

  /// `frame`: the pose of the map's frame in the frame of the export.
  explicit VoxelSelection(const SemanticMap& map, VoxelFilter filter = {},
                          const Eigen::Isometry3d& frame = Eigen::Isometry3d::Identity(),
                          Progress progress = {});

  const SemanticMap& map() const { return map_; }
  const VoxelFilter& filter() const { return filter_; }
  const Eigen::Isometry3d& frame() const { return frame_; }
  double resolution() const { return map_.grid().resolution(); }

  /// The same selection with, or without, the free voxels.
  VoxelSelection withFreeVoxels(bool free_voxels) const;
  /// The same selection wherever voxels lie.
  VoxelSelection withoutBox() const;

  /// False for an unknown voxel.
  bool takes(const VoxelIndex& index, const DirichletVoxel& voxel) const;

  /// Calls `visit(const VoxelIndex&, const ExportedVoxel&)` for each voxel of the selection, in the
  /// order of SemanticMap::forEachVoxel; the index is that in the map.
  template <class Visitor>
  void forEach(Visitor&& visit) const;

  /// The same for formats that are a voxel grid themselves: `visit` receives each voxel of the grid
  /// of the same resolution at the origin of the export's frame whose centre lies in a voxel of the
  /// selection, once. The index and the centre are those in that grid. A pose that is no multiple
  /// of voxels and right angles thus moves a voxel by up to half its diagonal. Throws ConfigError
  /// if a voxel lies beyond the grid's indices.
  template <class Visitor>
  void forEachResampled(Visitor&& visit) const;

  std::size_t count() const;
  /// Throws ConfigError if the selection is empty.
  void requireVoxels() const;
  /// Throws ConfigError if forEachResampled() visits no voxel: the selection is empty, or so small
  /// that no centre of the export's grid lies in it.
  void requireResampledVoxels() const;
  /// The smallest box around the voxels that forEachResampled() visits; nothing if there are none.
  std::optional<VoxelBox> resampledBounds() const;

 private:
  static ExportedVoxel describe(const DirichletVoxel& voxel, const Eigen::Vector3d& center);
  /// Box of the export's grid around a voxel of the map.
  VoxelBox targetsOf(const VoxelIndex& index) const;
  /// The voxel of the map that holds the centre of a voxel of the export's grid.
  bool isSource(const VoxelIndex& index, const Eigen::Vector3d& target_center) const;
  void report(std::size_t seen) const;

  template <class Visitor>
  void forEachSource(Visitor&& visit) const;

  const SemanticMap& map_;
  VoxelFilter filter_;
  Eigen::Isometry3d frame_;
  Eigen::Isometry3d to_map_;
  std::optional<VoxelBox> box_;
  Progress progress_;
  std::size_t known_voxels_;
};

// ---------------------------------------------------------------------------------------------

template <class Visitor>
void VoxelSelection::forEachSource(Visitor&& visit) const {
  std::size_t seen = 0;
  const auto visit_known = [&](const VoxelIndex& index, const DirichletVoxel& voxel) {
    report(++seen);
    if (takes(index, voxel)) visit(index, voxel);
  };
  if (!filter_.box)
    map_.forEachVoxel(visit_known);
  else if (box_)
    map_.forEachVoxelInBox(*box_, visit_known);
}

template <class Visitor>
void VoxelSelection::forEach(Visitor&& visit) const {
  forEachSource([&](const VoxelIndex& index, const DirichletVoxel& voxel) {
    visit(index, describe(voxel, frame_ * map_.grid().center(index)));
  });
}

template <class Visitor>
void VoxelSelection::forEachResampled(Visitor&& visit) const {
  forEachSource([&](const VoxelIndex& index, const DirichletVoxel& voxel) {
    const VoxelBox targets = targetsOf(index);
    VoxelIndex target;
    for (target.z = targets.min.z; target.z <= targets.max.z; ++target.z)
      for (target.y = targets.min.y; target.y <= targets.max.y; ++target.y)
        for (target.x = targets.min.x; target.x <= targets.max.x; ++target.x) {
          const Eigen::Vector3d center = map_.grid().center(target);
          if (isSource(index, center)) visit(std::as_const(target), describe(voxel, center));
        }
  });
}

}  // namespace csom
