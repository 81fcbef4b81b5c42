// SPDX-License-Identifier: BSD-3-Clause
// A map as an octree of OctoMap.
#include <csom/core/Error.h>
#include <csom/exports/OctomapFile.h>
#include <csom/io/OutputFile.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>

#include <csom/exports/ExportChecks.h>

namespace csom {
namespace {

constexpr std::int32_t kReach = 32768;

octomap::OcTreeKey keyOf(const VoxelIndex& v) {
  const auto part = [](std::int32_t index) {
    if (index < -kReach || index >= kReach)
      throw ConfigError(
          "an octree of OctoMap reaches 32768 voxels from the origin, and the map has voxels "
          "beyond; cut it or move it",
          {"box", "frame"});
    return static_cast<octomap::key_type>(index + kReach);
  };
  return {part(v.x), part(v.y), part(v.z)};
}

/// Log odds of a leaf, on the side of 0 on which the map's decision lies.
float logOddsOf(const ExportedVoxel& voxel) {
  const float log_odds = octomap::logodds(voxel.occupancy);
  return voxel.class_id == kFreeClass ? std::min(log_odds, -std::numeric_limits<float>::epsilon())
                                      : std::max(log_odds, 0.0F);
}

/// Occupied or free alone. Equal leaves are merged as they come, so that few are in memory at a
/// time.
std::size_t fill(const VoxelSelection& voxels, octomap::OcTree& tree) {
  std::size_t occupied = 0;
  voxels.forEachResampled([&](const VoxelIndex& index, const ExportedVoxel& voxel) {
    const bool free = voxel.class_id == kFreeClass;
    tree.setNodeValue(keyOf(index),
                      free ? tree.getClampingThresMinLog() : tree.getClampingThresMaxLog());
    if (!free) ++occupied;
  });
  return occupied;
}

std::size_t fill(const VoxelSelection& voxels, const LabelSet& labels, octomap::ColorOcTree& tree) {
  // As colours are set after the value, merging has to wait.
  constexpr bool kLazy = true;
  std::size_t occupied = 0;
  voxels.forEachResampled([&](const VoxelIndex& index, const ExportedVoxel& voxel) {
    const float log_odds =
        std::clamp(logOddsOf(voxel), tree.getClampingThresMinLog(), tree.getClampingThresMaxLog());
    octomap::ColorOcTreeNode* leaf = tree.setNodeValue(keyOf(index), log_odds, kLazy);
    const Color& color = labels.at(voxel.class_id).color;
    leaf->setColor(color[0], color[1], color[2]);
    if (voxel.class_id != kFreeClass) ++occupied;
  });
  tree.updateInnerOccupancy();
  return occupied;
}

/// ColorOcTree::prune() looks at occupancy alone and would mix the colours of classes.
void pruneEqualLeaves(octomap::ColorOcTree& tree, octomap::ColorOcTreeNode* node) {
  const octomap::ColorOcTreeNode* first = nullptr;
  bool equal = true;
  for (unsigned int i = 0; i < 8; ++i) {
    if (!tree.nodeChildExists(node, i)) {
      equal = false;
      continue;
    }
    octomap::ColorOcTreeNode* child = tree.getNodeChild(node, i);
    if (tree.nodeHasChildren(child)) pruneEqualLeaves(tree, child);
    if (first == nullptr) first = child;
    equal = equal && !tree.nodeHasChildren(child) && *child == *first;
  }
  if (equal) tree.pruneNode(node);
}

template <class Write>
void writeStream(const std::string& file, Write&& write) {
  OutputFile out(file);
  std::ofstream stream(out.path(), std::ios::binary);
  stream.precision(std::numeric_limits<double>::max_digits10);  // of the resolution
  if (!write(stream) || !stream.flush()) throw FileError(file, "cannot be written");
  stream.close();
  out.commit();
}

}  // namespace

std::size_t writeOctomap(const VoxelSelection& selection, const LabelSet& labels,
                         const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension != ".ot" && extension != ".bt")
    throw ConfigError(file +
                      ": name the file .ot (occupancy and classes) or .bt (occupancy alone)");
  detail::checkExport(selection, labels);
  selection.requireResampledVoxels();
  const VoxelSelection voxels = selection.withFreeVoxels(true);
  if (extension == ".bt") {
    octomap::OcTree tree(voxels.resolution());
    const std::size_t occupied = fill(voxels, tree);
    writeStream(file, [&](std::ostream& out) -> std::ostream& {
      // OcTree::writeBinary() does the same, and prints to standard error.
      out << "# Octomap OcTree binary file\nid OcTree\nsize " << tree.size() << "\nres "
          << tree.getResolution() << "\ndata\n";
      return tree.writeBinaryData(out);
    });
    return occupied;
  }
  octomap::ColorOcTree tree(voxels.resolution());
  const std::size_t occupied = fill(voxels, labels, tree);
  pruneEqualLeaves(tree, tree.getRoot());
  writeStream(file, [&](std::ostream& out) { return tree.write(out); });
  return occupied;
}

}  // namespace csom
