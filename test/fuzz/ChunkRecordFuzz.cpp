// SPDX-License-Identifier: BSD-3-Clause
// Records of chunks, without the hashes that keep random bytes away from them in a map file.
#include <csom/core/SemanticMap.h>

#include <cstdlib>
#include <stdexcept>

#include "FuzzTarget.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  csom::Options options;
  options.number_of_classes = 20;
  csom::SemanticMap map(options);
  try {
    map.addChunkRecord({1, -2, 3}, data, size);
  } catch (const std::runtime_error&) {
    if (!map.empty()) std::abort();
    return 0;
  }
  // What was accepted must be usable.
  std::size_t voxels = 0;
  map.forEachVoxel([&](const csom::VoxelIndex& index, const csom::DirichletVoxel& voxel) {
    ++voxels;
    if (voxel.size() != map.voxel(index).size() || voxel.probabilities().size() != 20) std::abort();
  });
  if (voxels != map.knownVoxelCount()) std::abort();
  map.merge(csom::SemanticMap(map));
  return 0;
}
