// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/SemanticMap.h>
#include <csom/protocols/LabelledCloud.h>

namespace csom {

void LabelledCloud::append(const LabelledCloud& other) {
  points.insert(points.end(), other.points.begin(), other.points.end());
  labels.insert(labels.end(), other.labels.begin(), other.labels.end());
}

Scan scanOf(const LabelledCloud& cloud, const Eigen::Vector3d& origin, const RangeImage& image) {
  Scan scan;
  scan.origin = origin;
  scan.image.column_step = image.column_step;
  scan.image.columns_of_turn = image.columns_of_turn;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.labels[i] == kFreeClass) continue;
    scan.points.push_back((cloud.points[i] - origin).cast<float>());
    scan.labels.push_back(cloud.labels[i]);
    if (!image.empty()) scan.image.pixels.push_back(image.pixels[i]);
  }
  return scan;
}

VoxelTruth computeTruth(const LabelledCloud& cloud, double resolution, int number_of_classes) {
  Options options;
  options.method = Method::SCsm;
  options.resolution = resolution;
  options.number_of_classes = number_of_classes;
  SemanticMap counts(options);
  // Rounded as scans are: a point on the border of two voxels lies in the same one for both.
  counts.insert(scanOf(cloud, Eigen::Vector3d::Zero()));
  VoxelTruth truth(counts);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.labels[i] != kFreeClass || !counts.grid().contains(cloud.points[i])) continue;
    const VoxelIndex voxel = counts.grid().voxelAt(cloud.points[i]);
    if (!counts.voxel(voxel).known()) truth.leaveOut(voxel);
  }
  return truth;
}

PointScore scorePoints(const Mapper& map, const LabelledCloud& cloud, int number_of_classes) {
  PointScore score(number_of_classes);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.labels[i] != kFreeClass) score.add(cloud.labels[i], map.at(cloud.points[i]));
  return score;
}

}  // namespace csom
