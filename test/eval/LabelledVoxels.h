// SPDX-License-Identifier: BSD-3-Clause
// Maps of a few voxels, one point each.
#pragma once

#include <csom/core/SemanticMap.h>

#include <vector>

namespace csom::test {

struct LabelledVoxel {
  VoxelIndex index;
  ClassId class_id;
};

/// Of classes 0 … 3.
inline SemanticMap mapOf(const std::vector<LabelledVoxel>& voxels, double resolution = 0.5) {
  Options options;
  options.method = Method::SCsm;
  options.resolution = resolution;
  options.number_of_classes = 4;
  SemanticMap map(options);
  Scan scan;
  for (const LabelledVoxel& v : voxels) {
    scan.points.push_back(map.grid().center(v.index).cast<float>());
    scan.labels.push_back(v.class_id);
  }
  map.insert(scan);
  return map;
}

}  // namespace csom::test
