// SPDX-License-Identifier: BSD-3-Clause
// Labelled points, what is true of the voxels that hold them, and scans made of them.
#pragma once

#include <csom/core/types.h>
#include <csom/eval/Mapper.h>
#include <csom/eval/PointScore.h>
#include <csom/eval/VoxelTruth.h>

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace csom {

/// Points in the map frame [m], a class each; kFreeClass marks a point whose label is not to be
/// used: whatever is there is not scored.
struct LabelledCloud {
  std::vector<Eigen::Vector3d> points;
  std::vector<ClassId> labels;

  void add(const Eigen::Vector3d& point, ClassId label) {
    points.push_back(point);
    labels.push_back(label);
  }
  void append(const LabelledCloud& other);
  std::size_t size() const { return points.size(); }
};

/// The points that have a label, as seen from `origin`; with `image`, which is that of all points,
/// the pixels of these.
Scan scanOf(const LabelledCloud& cloud, const Eigen::Vector3d& origin,
            const RangeImage& image = {});

/// The majority class (ties: the lower id) of the labelled points in each voxel. Voxels that hold
/// points but no labelled one are left out. Throws std::invalid_argument if there is no labelled
/// point.
VoxelTruth computeTruth(const LabelledCloud& cloud, double resolution, int number_of_classes);

/// What a map says of the labelled points.
PointScore scorePoints(const Mapper& map, const LabelledCloud& cloud, int number_of_classes);

}  // namespace csom
