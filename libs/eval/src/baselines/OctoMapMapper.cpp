// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/OctoMapMapper.h>
#include <octomap/octomap.h>

#include <stdexcept>
#include <string>

#include "baselines/BetaCounts.h"
#include "baselines/TrainingData.h"

namespace csom {
namespace {

octomap::point3d pointOf(const Eigen::Vector3d& p) {
  const Eigen::Vector3f f = p.cast<float>();
  return {f.x(), f.y(), f.z()};
}

/// liboctomap itself would wrap around, or drop the point with a message.
void checkReach(const octomap::OcTree& tree, const Eigen::Vector3d& point) {
  octomap::OcTreeKey key;
  if (!tree.coordToKeyChecked(pointOf(point), key))
    throw std::invalid_argument("OctoMap reaches 32768 voxels of " +
                                toString(tree.getResolution()) +
                                " m from the map's origin; a point or sensor lies beyond");
}

octomap::KeySet keysOf(const octomap::OcTree& tree, const std::vector<Eigen::Vector3d>& points) {
  octomap::KeySet keys;
  for (const Eigen::Vector3d& point : points) keys.insert(tree.coordToKey(pointOf(point)));
  return keys;
}

}  // namespace

OctoMapMapper::OctoMapMapper(const Options& input, const OctoMapParameters& parameters)
    : input_(detail::validInput(input)), parameters_(parameters) {
  // The bounds between which liboctomap's own assertions hold.
  detail::checkParameter("hit_probability", parameters_.hit_probability, 0.5, 0.999);
  detail::checkParameter("miss_probability", parameters_.miss_probability, 0.001, 0.5);
  detail::checkParameter("clamping_min", parameters_.clamping_min, 1e-6, 0.5);
  detail::checkParameter("clamping_max", parameters_.clamping_max, 0.5, 1 - 1e-6);
  detail::checkParameter("occupied_threshold", parameters_.occupied_threshold, 0, 1);
  tree_ = std::make_unique<octomap::OcTree>(input_.resolution);
  tree_->setProbHit(parameters_.hit_probability);
  tree_->setProbMiss(parameters_.miss_probability);
  tree_->setClampingThresMin(parameters_.clamping_min);
  tree_->setClampingThresMax(parameters_.clamping_max);
}

OctoMapMapper::~OctoMapMapper() = default;

void OctoMapMapper::insert(const Scan& scan) {
  const detail::TrainingData data = detail::makeTrainingData(scan, input_, FreeSpace::None);
  if (data.hits.empty() && data.free_points.empty()) return;
  checkReach(*tree_, data.origin);
  for (const Eigen::Vector3d& hit : data.hits) checkReach(*tree_, hit);
  for (const Eigen::Vector3d& point : data.free_points) checkReach(*tree_, point);

  if (input_.free_space.mode == FreeSpace::None) {
    for (const octomap::OcTreeKey& key : keysOf(*tree_, data.hits)) tree_->updateNode(key, true);
  } else {
    octomap::Pointcloud cloud;
    for (const Eigen::Vector3d& hit : data.hits) cloud.push_back(pointOf(hit));
    constexpr double kNoMaxRange = -1;
    constexpr bool kLazy = false;
    constexpr bool kDiscretise = true;
    tree_->insertPointCloud(cloud, pointOf(data.origin), kNoMaxRange, kLazy, kDiscretise);
  }
  for (const octomap::OcTreeKey& key : keysOf(*tree_, data.free_points))
    tree_->updateNode(key, false);
}

VoxelEstimate OctoMapMapper::at(const Eigen::Vector3d& center) const {
  octomap::OcTreeKey key;
  if (!tree_->coordToKeyChecked(center.x(), center.y(), center.z(), key)) return {};
  const octomap::OcTreeNode* node = tree_->search(key);
  if (node == nullptr) return {};
  return detail::occupancyEstimate(node->getOccupancy(), parameters_.occupied_threshold);
}

}  // namespace csom
