// SPDX-License-Identifier: BSD-3-Clause
// Counts of a map by state and class.
#include <csom/report/MapFigures.h>

#include <algorithm>

namespace csom {

namespace {

std::vector<ClassFigures> classesOf(const LabelSet& labels, const Options& options) {
  // A map may have fewer or more classes than its label set names.
  const int classes = std::max(labels.numberOfClasses(), options.number_of_classes);
  std::vector<ClassFigures> figures(static_cast<std::size_t>(classes));
  for (int k = 0; k < classes; ++k) {
    ClassFigures& c = figures[static_cast<std::size_t>(k)];
    c.id = static_cast<ClassId>(k);
    if (k < labels.numberOfClasses()) {
      c.name = labels.at(c.id).name;
      c.color = labels.at(c.id).color;
    } else {
      c.name = "class " + std::to_string(k);
      c.color = LabelClass{}.color;
    }
  }
  return figures;
}

Eigen::AlignedBox3d computeBounds(const SemanticMap& map) {
  const auto box = map.boundingBox();
  if (!box) return {};
  const VoxelIndex beyond{box->max.x + 1, box->max.y + 1, box->max.z + 1};
  return {map.grid().lowerCorner(box->min), map.grid().lowerCorner(beyond)};
}

}  // namespace

MapFiguresSum::MapFiguresSum(const LabelSet& labels, const Options& options) {
  sum_.resolution = options.resolution;
  sum_.classes = classesOf(labels, options);
}

void MapFiguresSum::add(const SemanticMap& part) {
  sum_.chunks += part.chunks().chunkCount();
  sum_.memory_bytes += part.memoryBytes();
  sum_.bounds.extend(computeBounds(part));
  part.forEachVoxel([&](const VoxelIndex&, const DirichletVoxel& voxel) {
    ++sum_.known_voxels;
    const ClassId k = voxel.mostLikelyClass();
    ++(k == kFreeClass ? sum_.free_voxels : sum_.occupied_voxels);
    ClassFigures& c = sum_.classes[k];
    ++c.voxels;
    c.mean_probability += voxel.probability(k);
  });
}

MapFigures MapFiguresSum::figures(const std::string& digest) const {
  MapFigures figures = sum_;
  figures.digest = digest;
  const double voxel_volume = figures.resolution * figures.resolution * figures.resolution;
  for (ClassFigures& c : figures.classes) {
    if (c.voxels == 0) continue;
    const auto voxels = static_cast<double>(c.voxels);
    c.mean_probability /= voxels;
    c.volume = voxels * voxel_volume;
    if (c.id != kFreeClass) c.share = voxels / static_cast<double>(figures.occupied_voxels);
  }
  return figures;
}

MapFigures computeFigures(const MapDocument& document) {
  MapFiguresSum sum(document.labels, document.map.options());
  sum.add(document.map);
  return sum.figures(mapDigest(document.map));
}

}  // namespace csom
