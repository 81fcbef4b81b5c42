// SPDX-License-Identifier: BSD-3-Clause
// Counts of a map by state and class.
#include <csom/report/MapFigures.h>

#include <algorithm>

namespace csom {

namespace {

std::vector<ClassFigures> classesOf(const MapDocument& document) {
  // A map may have fewer or more classes than its label set names.
  const int classes =
      std::max(document.labels.numberOfClasses(), document.map.options().number_of_classes);
  std::vector<ClassFigures> figures(static_cast<std::size_t>(classes));
  for (int k = 0; k < classes; ++k) {
    ClassFigures& c = figures[static_cast<std::size_t>(k)];
    c.id = static_cast<ClassId>(k);
    if (k < document.labels.numberOfClasses()) {
      c.name = document.labels.at(c.id).name;
      c.color = document.labels.at(c.id).color;
    } else {
      c.name = "class " + std::to_string(k);
      c.color = LabelClass{}.color;
    }
  }
  return figures;
}

Eigen::AlignedBox3d boundsOf(const SemanticMap& map) {
  const auto box = map.boundingBox();
  if (!box) return {};
  const VoxelIndex beyond{box->max.x + 1, box->max.y + 1, box->max.z + 1};
  return {map.grid().lowerCorner(box->min), map.grid().lowerCorner(beyond)};
}

}  // namespace

MapFigures figuresOf(const MapDocument& document) {
  const SemanticMap& map = document.map;
  MapFigures figures;
  figures.resolution = map.grid().resolution();
  figures.chunks = map.chunks().chunkCount();
  figures.memory_bytes = map.memoryBytes();
  figures.bounds = boundsOf(map);
  figures.digest = mapDigest(map);
  figures.classes = classesOf(document);

  map.forEachVoxel([&](const VoxelIndex&, const DirichletVoxel& voxel) {
    ++figures.known_voxels;
    const ClassId k = voxel.mostLikelyClass();
    ++(k == kFreeClass ? figures.free_voxels : figures.occupied_voxels);
    ClassFigures& c = figures.classes[k];
    ++c.voxels;
    c.mean_probability += voxel.probability(k);  // the sum, so far
  });

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

}  // namespace csom
