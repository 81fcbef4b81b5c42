// SPDX-License-Identifier: BSD-3-Clause
// Voxels in the colours of their classes.
#include <csom/maps/CSemanticContinuousMap.h>
#include <mrpt/opengl/COctoMapVoxels.h>
#include <mrpt/opengl/CSetOfObjects.h>

namespace csom {
namespace {

using mrpt::opengl::COctoMapVoxels;
using mrpt::opengl::VOXEL_SET_FREESPACE;
using mrpt::opengl::VOXEL_SET_OCCUPIED;

mrpt::math::TPoint3D toPoint(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

void addVoxels(const SemanticMap& map, const LabelSet& labels,
               const CSemanticContinuousMap::TRenderingOptions& options, COctoMapVoxels& voxels) {
  map.forEachVoxel([&](const VoxelIndex& index, const DirichletVoxel& voxel) {
    const bool occupied = voxel.state() == VoxelState::Occupied;
    if (occupied ? !options.occupied_voxels : !options.free_voxels) return;
    const Color& c = labels.at(voxel.mostLikelyClass()).color;
    constexpr std::uint8_t kOpaque = 255;
    constexpr std::uint8_t kFaint = 20;
    const mrpt::img::TColor color(c[0], c[1], c[2], occupied ? kOpaque : kFaint);
    voxels.push_back_Voxel(
        occupied ? VOXEL_SET_OCCUPIED : VOXEL_SET_FREESPACE,
        {toPoint(map.grid().center(index)).cast<float>(), map.grid().resolution(), color});
  });
}

}  // namespace

void CSemanticContinuousMap::getVisualizationInto(mrpt::opengl::CSetOfObjects& scene) const {
  const std::optional<VoxelBox> box = map_.boundingBox();
  if (!genericMapParams.enableSaveAs3DObject || !box) return;
  auto voxels = COctoMapVoxels::Create();
  voxels->setVisualizationMode(COctoMapVoxels::FIXED);
  voxels->enableLights(true);
  voxels->resizeVoxelSets(2);
  addVoxels(map_, labels(), renderingOptions, *voxels);
  const VoxelIndex& max = box->max;
  voxels->setBoundingBox(toPoint(map_.grid().lowerCorner(box->min)),
                         toPoint(map_.grid().lowerCorner({max.x + 1, max.y + 1, max.z + 1})));
  scene.insert(voxels);
}

}  // namespace csom
