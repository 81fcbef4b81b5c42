// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Grid.h>

#include <numeric>

#include "inference/ClassMass.h"
#include "inference/Counts.h"
#include "inference/Inference.h"
#include "inference/VoxelRuns.h"
#include "util/SortedKeys.h"

namespace csom::detail {

// Each observed voxel receives the class mass of its own points.
ScanIncrements inferSCsm(const PreparedScan& scan, const Options& options, ScanReport& report) {
  const auto classes = static_cast<std::size_t>(options.number_of_classes);
  const auto sorted = sortedByPosition(scan.blocks.size(), [&](std::size_t b) {
    const BlockIndex& voxel = scan.blocks[b];
    return KeyPacking::Position{chunkOf(voxel.x), chunkOf(voxel.y), chunkOf(voxel.z)};
  });

  ScanIncrements out;
  VoxelRuns runs;
  std::vector<double> mass(classes);
  std::vector<ClassId> all_classes(classes);
  std::iota(all_classes.begin(), all_classes.end(), ClassId{0});
  forEachRun(sorted, [&](std::size_t begin, std::size_t end) {
    for (std::size_t entry = begin; entry < end; ++entry) {
      const std::size_t b = sorted[entry].item;
      sumClassMass(scan, b, mass);
      const BlockIndex& voxel = scan.blocks[b];
      runs.add(indexInChunk({voxel.x, voxel.y, voxel.z}), all_classes.data(), classes,
               [&](std::size_t k) { return toCount(mass[k]); });
    }
    const BlockIndex& first = scan.blocks[sorted[begin].item];
    report.voxels_updated += runs.voxelCount();
    out.push_back({chunkOf(VoxelIndex{first.x, first.y, first.z}), runs.take()});
  });
  report.blocks_filled += scan.blocks.size();
  return out;
}

}  // namespace csom::detail
