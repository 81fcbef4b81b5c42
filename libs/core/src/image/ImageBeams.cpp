// SPDX-License-Identifier: BSD-3-Clause
#include "image/ImageBeams.h"

#include <csom/core/Grid.h>

#include <algorithm>

#include "util/Parallel.h"

namespace csom::detail {

namespace {

ClassId likeliest(const float* scores, int classes) {
  return static_cast<ClassId>(std::max_element(scores, scores + classes) - scores);
}

}  // namespace

void ImageBeams::read(const PreparedScan& scan, const Options& options) {
  const ImagePoints& in = scan.image_points;
  neighbours.find(in.image, options.threads);
  const Grid grid(options.resolution);
  base = voxelOfChunk(chunkOf(grid.voxelAt(scan.origin)), 0);
  const auto positionOf = [&](const Eigen::Vector3d& in_map) -> HalfStepPosition {
    constexpr double kSteps = 1 << (HalfStepPosition::kBits - 1);
    const auto along = [&](double coordinate, std::int32_t base_voxel) {
      const double steps = (coordinate / options.resolution - base_voxel) * kSteps;
      const auto whole = static_cast<std::int32_t>(steps);  // towards 0: no call as std::floor() is
      return 2 * (whole - (steps < whole ? 1 : 0)) + 1;
    };
    return {along(in_map.x(), base.x), along(in_map.y(), base.y), along(in_map.z(), base.z)};
  };
  sensor = positionOf(scan.origin);
  positions.resize(in.points.size());
  parallelRanges(in.points.size(), options.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      positions[i] = positionOf(scan.origin + in.points[i].cast<double>());
  });
  const std::size_t beams = neighbours.size();
  for (std::vector<float>* axis : {&x, &y, &z}) axis->resize(beams);
  label.resize(beams);
  parallelRanges(beams, options.threads, [&](std::size_t begin, std::size_t end) {
    const auto classes = static_cast<std::size_t>(options.number_of_classes);
    for (std::size_t beam = begin; beam < end; ++beam) {
      const std::size_t point = neighbours.point[beam];
      x[beam] = in.points[point].x();
      y[beam] = in.points[point].y();
      z[beam] = in.points[point].z();
      label[beam] = in.scores.empty()
                        ? in.labels[point]
                        : likeliest(in.scores.data() + point * classes, options.number_of_classes);
    }
  });
}

}  // namespace csom::detail
