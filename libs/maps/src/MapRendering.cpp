// SPDX-License-Identifier: BSD-3-Clause
// Voxels for MRPT's 3-D views.
#include <csom/core/Error.h>
#include <csom/io/OutputFile.h>
#include <csom/maps/CSemanticContinuousMap.h>
#include <mrpt/img/color_maps.h>
#include <mrpt/opengl/COctoMapVoxels.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfObjects.h>

#include <algorithm>
#include <array>
#include <set>

namespace csom {
namespace {

using mrpt::img::TColor;
using mrpt::opengl::COctoMapVoxels;
using mrpt::opengl::VOXEL_SET_FREESPACE;
using mrpt::opengl::VOXEL_SET_OCCUPIED;

constexpr unsigned kVoxelSetUnknown = 2;  // MRPT has names for the first two only
constexpr std::uint8_t kOpaque = 255;
constexpr std::uint8_t kFaint = 20;

mrpt::math::TPoint3D toPoint(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

std::array<VoxelIndex, 6> besides(const VoxelIndex& v) {
  return {VoxelIndex{v.x - 1, v.y, v.z}, VoxelIndex{v.x + 1, v.y, v.z},
          VoxelIndex{v.x, v.y - 1, v.z}, VoxelIndex{v.x, v.y + 1, v.z},
          VoxelIndex{v.x, v.y, v.z - 1}, VoxelIndex{v.x, v.y, v.z + 1}};
}

bool isHidden(const SemanticMap& map, const VoxelIndex& index, VoxelState state) {
  const auto neighbours = besides(index);
  return std::all_of(neighbours.begin(), neighbours.end(), [&](const VoxelIndex& neighbour) {
    return map.voxel(neighbour).state() == state;
  });
}

/// From blue (0) to red (1).
TColor heat(double value) {
  return mrpt::img::colormap(mrpt::img::cmJET, static_cast<float>(std::clamp(value, 0.0, 1.0)));
}

/// Puts the voxels of a map into an object of MRPT's views.
class VoxelPainter {
 public:
  VoxelPainter(const SemanticMap& map, const LabelSet& labels, const RenderingOptions& options,
               const VoxelBox& box, COctoMapVoxels& voxels)
      : map_(map), labels_(labels), options_(options), box_(box), voxels_(voxels) {}

  void paint() {
    std::set<VoxelIndex> unknown;
    map_.forEachVoxel([&](const VoxelIndex& index, const DirichletVoxel& voxel) {
      const VoxelState state = voxel.state();
      const bool is_free = state == VoxelState::Free;
      if (is_free && options_.unknown_voxels) addUnknownBeside(index, unknown);
      if (is_free ? !options_.free_voxels : !options_.occupied_voxels) return;
      if (options_.visible_only && isHidden(map_, index, state)) return;
      add(is_free ? VOXEL_SET_FREESPACE : VOXEL_SET_OCCUPIED, index,
          is_free ? faintColorOf(voxel) : colorOf(index, voxel));
    });
    for (const VoxelIndex& index : unknown) {
      constexpr std::uint8_t kGray = 128;
      add(kVoxelSetUnknown, index, TColor(kGray, kGray, kGray, kFaint));
    }
  }

 private:
  void addUnknownBeside(const VoxelIndex& index, std::set<VoxelIndex>& unknown) const {
    for (const VoxelIndex& neighbour : besides(index))
      if (map_.voxel(neighbour).state() == VoxelState::Unknown) unknown.insert(neighbour);
  }

  TColor classColor(const DirichletVoxel& voxel, std::uint8_t opacity) const {
    const Color& c = labels_.at(voxel.mostLikelyClass()).color;
    return {c[0], c[1], c[2], opacity};
  }

  TColor faintColorOf(const DirichletVoxel& voxel) const { return classColor(voxel, kFaint); }

  TColor colorOf(const VoxelIndex& index, const DirichletVoxel& voxel) const {
    switch (options_.color_by) {
      case VoxelColor::Probability:
        return heat(voxel.probability(voxel.mostLikelyClass()));
      case VoxelColor::Height:
        return heat(static_cast<double>(index.z - box_.min.z) /
                    std::max(1, box_.max.z - box_.min.z));
      default:
        return classColor(voxel, kOpaque);
    }
  }

  void add(unsigned set, const VoxelIndex& index, const TColor& color) {
    voxels_.push_back_Voxel(
        set, {toPoint(map_.grid().center(index)).cast<float>(), map_.grid().resolution(), color});
  }

  const SemanticMap& map_;
  const LabelSet& labels_;
  const RenderingOptions& options_;
  const VoxelBox& box_;
  COctoMapVoxels& voxels_;
};

}  // namespace

void CSemanticContinuousMap::getVisualizationInto(mrpt::opengl::CSetOfObjects& scene) const {
  const std::optional<VoxelBox> box = map_.boundingBox();
  if (!genericMapParams.enableSaveAs3DObject || !box) return;
  auto voxels = COctoMapVoxels::Create();
  voxels->setVisualizationMode(COctoMapVoxels::FIXED);
  voxels->enableLights(true);
  voxels->resizeVoxelSets(kVoxelSetUnknown + 1);
  VoxelPainter(map_, labels(), renderingOptions, *box, *voxels).paint();
  // What is unknown lies around what is known.
  const int margin = renderingOptions.unknown_voxels ? 1 : 0;
  const auto cornerOf = [&](const VoxelIndex& v, int shift) {
    return toPoint(map_.grid().lowerCorner({v.x + shift, v.y + shift, v.z + shift}));
  };
  voxels->setBoundingBox(cornerOf(box->min, -margin), cornerOf(box->max, 1 + margin));
  scene.insert(voxels);
}

void CSemanticContinuousMap::saveScene(const std::string& file) const {
  auto objects = mrpt::opengl::CSetOfObjects::Create();
  getVisualizationInto(*objects);
  mrpt::opengl::COpenGLScene scene;
  scene.insert(objects);
  OutputFile output(file);
  if (!scene.saveToFile(output.path())) throw FileError(file, "cannot be written");
  output.commit();
}

}  // namespace csom
