// SPDX-License-Identifier: BSD-3-Clause
// Packs voxels for the viewer of the page.
#include "ViewerModel.h"

#include <csom/report/MapPicture.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "ClassColors.h"
#include "CubePacker.h"
#include "Palette.h"
#include "Trajectories.h"
#include "ViewAxes.h"

namespace csom {

namespace {

using Json = nlohmann::ordered_json;

/// A tile costs the browser some kilobytes, however empty it is.
constexpr std::size_t kMaxTiles = 15'000;

/// The box without the outermost cubes, which may be far away.
Json focusOf(const std::vector<Cube>& cubes) {
  Json low = Json::array(), high = Json::array();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<std::int32_t> places;
    places.reserve(cubes.size());
    for (const Cube& cube : cubes) places.push_back(cube.index()[axis]);
    std::sort(places.begin(), places.end());
    const std::size_t margin = places.size() / 200;
    low.push_back(places[margin]);
    high.push_back(places[places.size() - 1 - margin] + 1);
  }
  return {{"low", low}, {"high", high}};
}

Json makeLayers(const std::vector<Cube>& cubes, const SignedAxis& up) {
  std::int32_t low = std::numeric_limits<std::int32_t>::max(), high = -low;
  for (const Cube& cube : cubes) {
    const std::array<std::int32_t, 3> place = cube.index();
    const std::int32_t layer = up.along(VoxelIndex{place[0], place[1], place[2]});
    low = std::min(low, layer);
    high = std::max(high, layer);
  }
  return {{"low", low}, {"high", high}};
}

Json classesOf(const CubePacker& packer, const LabelSet& labels) {
  std::array<std::size_t, kMaxClasses> counts{};
  for (const Cube& cube : packer.cubes()) ++counts[packer.classOf(cube)];
  std::vector<ClassId> present;
  for (std::size_t k = 0; k < counts.size(); ++k)
    if (counts[k] > 0) present.push_back(static_cast<ClassId>(k));
  std::stable_sort(present.begin(), present.end(),
                   [&](ClassId a, ClassId b) { return counts[a] > counts[b]; });
  Json classes = Json::array();
  for (const ClassId k : present) {
    const LabelClass label = classOf(labels, k);
    const auto& hidden = MapPictureOptions().hidden_classes;
    const bool shown = std::find(hidden.begin(), hidden.end(), label.name) == hidden.end();
    classes.push_back({{"id", k}, {"name", label.name}, {"voxels", counts[k]}, {"shown", shown}});
  }
  return classes;
}

Json classNamesOf(const MapDocument& document) {
  const std::vector<Color> colors = labelColors(document), safe = colorBlindSafeColors(document);
  Json names = Json::array();
  for (std::size_t k = 0; k < colors.size(); ++k)
    names.push_back({{"name", classOf(document.labels, static_cast<ClassId>(k)).name},
                     {"color", colors[k]},
                     {"safeColor", safe[k]}});
  return names;
}

Json makeTrajectories(const RunRecord& record, double cube_edge) {
  Json trajectories = Json::array();
  for (const std::vector<Eigen::Vector3d>& places : trajectories3d(record)) {
    Json points = Json::array();
    for (const Eigen::Vector3d& p : places) {
      Json point = Json::array();
      for (int axis = 0; axis < 3; ++axis)
        point.push_back(std::round(p[axis] / cube_edge * 100) / 100);
      points.push_back(point);
    }
    trajectories.push_back(points);
  }
  return trajectories;
}

Json rangeJson(std::pair<double, double> range) {
  return {{"min", range.first}, {"max", range.second}};
}

std::vector<std::uint8_t> deflated(const std::vector<std::uint8_t>& bytes) {
  uLongf size = compressBound(bytes.size());
  std::vector<std::uint8_t> packed(size);
  if (compress2(packed.data(), &size, bytes.data(), bytes.size(), 6) != Z_OK)
    throw std::runtime_error("zlib cannot pack the voxels of the page");
  packed.resize(size);
  return packed;
}

}  // namespace

ViewerModel viewerModel(const MapDocument& document, const RunRecord& record,
                        std::size_t most_cubes) {
  ViewerModel model;
  const int level = cubeLevel(document.map, most_cubes, kMaxTiles);
  const CubePacker packer(document.map, level);
  model.cubes = packer.cubes().size();
  model.voxels_per_cube = 1 << level;
  if (model.cubes == 0) return model;

  const double edge = document.map.grid().resolution() * model.voxels_per_cube;
  const SignedAxis up = ViewAxes::standing(record.up).up;
  const Json header = {{"resolution", edge},
                       {"tiles", packer.tileCount()},
                       {"voxels", model.cubes},
                       {"vectorEntries", packer.entryCount()},
                       {"voxelsPerCube", model.voxels_per_cube},
                       {"up", {{"axis", up.axis}, {"sign", up.sign}}},
                       {"focus", focusOf(packer.cubes())},
                       {"layers", makeLayers(packer.cubes(), up)},
                       {"classes", classesOf(packer, document.labels)},
                       {"classNames", classNamesOf(document)},
                       {"variance", rangeJson(packer.variance())},
                       {"evidence", rangeJson(packer.evidence())},
                       {"trajectories", makeTrajectories(record, edge)}};
  model.header = header.dump(-1, ' ', false, Json::error_handler_t::replace);
  model.data = deflated(packer.pack());
  return model;
}

}  // namespace csom
