// SPDX-License-Identifier: BSD-3-Clause
// csom query: one question to a map.
#include <csom/core/Error.h>
#include <csom/exports/VoxelSelection.h>
#include <csom/io/MapFile.h>
#include <csom/io/TextParser.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "Arguments.h"
#include "Output.h"
#include "VoxelFilterArguments.h"
#include "commands.h"

namespace csom {

namespace {

struct QueryArguments {
  std::string file;
  std::optional<std::array<double, 3>> point;
  std::optional<std::array<double, 6>> ray;
  std::optional<std::array<double, 6>> box;
  std::optional<std::array<double, 3>> nearest;
  std::vector<std::string> classes;
  double max_range = std::numeric_limits<double>::infinity();
  bool json = false;
};

Eigen::Vector3d vectorAt(const std::array<double, 6>& numbers, std::size_t first) {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

/// All that can be said about one voxel.
Json voxelToJson(const DirichletVoxel& voxel, const LabelSet& labels) {
  const ClassId best = voxel.mostLikelyClass();
  Json json;
  json["state"] = toString(voxel.state());
  json["class_id"] = nullptr;
  json["class_name"] = nullptr;
  if (voxel.known()) {
    json["class_id"] = best;
    json["class_name"] = labels.at(best).name;
  }
  json["probability"] = voxel.probability(best);
  json["variance"] = voxel.variance(best);
  json["occupancy"] = voxel.occupancy();
  json["entropy"] = voxel.entropy();
  json["evidence"] = voxel.evidence();
  json["probabilities"] = voxel.probabilities();
  return json;
}

void printVoxel(const DirichletVoxel& voxel, const LabelSet& labels) {
  std::printf("state        %s\n", toString(voxel.state()));
  if (!voxel.known()) return;
  const ClassId best = voxel.mostLikelyClass();
  std::printf("class        %d %s\n", best, detail::printable(labels.at(best).name).c_str());
  std::printf("probability  %s, variance %s\n", toText(voxel.probability(best)).c_str(),
              toText(voxel.variance(best)).c_str());
  std::printf("occupancy    %s\n", toText(voxel.occupancy()).c_str());
  std::printf("entropy      %s\n", toText(voxel.entropy()).c_str());
  std::printf("evidence     %s\n", toText(voxel.evidence()).c_str());
  for (int i = 0; i < voxel.size(); ++i) {
    const ClassId k = voxel.classAt(i);
    std::printf("  %3d  %-20s probability %-10s evidence %s\n", k,
                detail::printable(labels.at(k).name).c_str(), toText(voxel.probability(k)).c_str(),
                toText(voxel.evidence(k)).c_str());
  }
}

void queryPoint(const MapDocument& document, const QueryArguments& arguments) {
  const Eigen::Vector3d point((*arguments.point)[0], (*arguments.point)[1], (*arguments.point)[2]);
  const Grid& grid = document.map.grid();
  if (!grid.isAddressable(point))
    throw ConfigError("--point " + toText(point) + " is farther than this map can address");
  const VoxelIndex index = grid.voxelAt(point);
  const DirichletVoxel voxel = document.map.voxel(index);
  if (arguments.json) {
    Json json{
        {"point", toJson(point)}, {"voxel", toJson(index)}, {"center", toJson(grid.center(index))}};
    json.update(voxelToJson(voxel, document.labels));
    printJson(json);
    return;
  }
  std::printf("voxel        %d %d %d, centre %s m\n", index.x, index.y, index.z,
              toText(grid.center(index)).c_str());
  printVoxel(voxel, document.labels);
}

void queryRay(const MapDocument& document, const QueryArguments& arguments) {
  const Eigen::Vector3d origin = vectorAt(*arguments.ray, 0);
  const Eigen::Vector3d direction = vectorAt(*arguments.ray, 3);
  if (!document.map.grid().isAddressable(origin))
    throw ConfigError("--ray starts farther away than this map can address");
  const auto hit = document.map.castRay(origin, direction, arguments.max_range);
  if (arguments.json) {
    Json json{{"origin", toJson(origin)}, {"direction", toJson(direction)}, {"hit", bool(hit)}};
    if (hit) {
      json["distance"] = hit->distance;
      json["point"] = toJson(hit->point);
      json["voxel"] = toJson(hit->voxel);
      json["center"] = toJson(document.map.grid().center(hit->voxel));
      json.update(voxelToJson(document.map.voxel(hit->voxel), document.labels));
    }
    printJson(json);
    return;
  }
  if (!hit) {
    std::puts("no hit       the ray meets no occupied voxel");
    return;
  }
  std::printf("hit          at %s m, %s m from the origin\n", toText(hit->point).c_str(),
              toText(hit->distance).c_str());
  std::printf("voxel        %d %d %d, centre %s m\n", hit->voxel.x, hit->voxel.y, hit->voxel.z,
              toText(document.map.grid().center(hit->voxel)).c_str());
  printVoxel(document.map.voxel(hit->voxel), document.labels);
}

/// Of the given classes, or of all if there are none.
std::optional<Neighbour> nearestOf(const SemanticMap& map, const std::set<ClassId>& classes,
                                   const Eigen::Vector3d& point, double max_range) {
  if (classes.empty()) return map.nearestOccupied(point, max_range);
  std::optional<Neighbour> nearest;
  for (const ClassId k : classes) {
    const double limit = nearest ? nearest->distance : max_range;
    const auto found = map.nearestOccupied(point, limit, k);
    if (found && (!nearest || found->distance < nearest->distance)) nearest = found;
  }
  return nearest;
}

void queryNearest(const MapDocument& document, const QueryArguments& arguments) {
  const Eigen::Vector3d point((*arguments.nearest)[0], (*arguments.nearest)[1],
                              (*arguments.nearest)[2]);
  const Grid& grid = document.map.grid();
  if (!grid.isAddressable(point))
    throw ConfigError("--nearest " + toText(point) + " is farther than this map can address");
  const auto nearest =
      nearestOf(document.map, classesNamed("--classes", arguments.classes, document.labels), point,
                arguments.max_range);
  if (arguments.json) {
    Json json{{"point", toJson(point)}, {"distance", nullptr}};
    if (nearest) {
      json["distance"] = nearest->distance;
      json["voxel"] = toJson(nearest->voxel);
      json["center"] = toJson(grid.center(nearest->voxel));
      json.update(voxelToJson(document.map.voxel(nearest->voxel), document.labels));
    }
    printJson(json);
    return;
  }
  if (!nearest) {
    std::puts("distance     no occupied voxel within the range");
    return;
  }
  std::printf("distance     %s m\n", toText(nearest->distance).c_str());
  std::printf("voxel        %d %d %d, centre %s m\n", nearest->voxel.x, nearest->voxel.y,
              nearest->voxel.z, toText(grid.center(nearest->voxel)).c_str());
  printVoxel(document.map.voxel(nearest->voxel), document.labels);
}

void queryBox(const MapDocument& document, const QueryArguments& arguments) {
  const Eigen::Vector3d min = vectorAt(*arguments.box, 0);
  const Eigen::Vector3d max = vectorAt(*arguments.box, 3);
  const Grid& grid = document.map.grid();
  std::vector<std::size_t> voxels_of_class(document.labels.classes().size());
  Json voxels = Json::array();
  if (const auto box = voxelsWithCenterIn(grid, Eigen::AlignedBox3d(min, max))) {
    document.map.forEachVoxelInBox(*box, [&](const VoxelIndex& index, const DirichletVoxel& v) {
      const ClassId best = v.mostLikelyClass();
      ++voxels_of_class[best];
      if (arguments.json)
        voxels.push_back({{"center", toJson(grid.center(index))},
                          {"class_id", best},
                          {"probability", v.probability(best)}});
    });
  }
  std::size_t known = 0;
  for (const std::size_t count : voxels_of_class) known += count;
  const std::size_t free = voxels_of_class[kFreeClass];
  if (arguments.json) {
    Json classes = Json::array();
    for (const LabelClass& c : document.labels.classes())
      if (voxels_of_class[c.id] != 0)
        classes.push_back({{"id", c.id}, {"name", c.name}, {"voxels", voxels_of_class[c.id]}});
    printJson({{"min", toJson(min)},
               {"max", toJson(max)},
               {"known_voxels", known},
               {"occupied_voxels", known - free},
               {"free_voxels", free},
               {"classes", classes},
               {"voxels", voxels}});
    return;
  }
  std::printf("known voxels %zu: %zu occupied, %zu free\n", known, known - free, free);
  for (const LabelClass& c : document.labels.classes())
    if (voxels_of_class[c.id] != 0)
      std::printf("  %3d  %-20s %10zu\n", c.id, detail::printable(c.name).c_str(),
                  voxels_of_class[c.id]);
}

void runQuery(const QueryArguments& arguments) {
  const MapDocument document = loadMap(arguments.file);
  if (arguments.point) queryPoint(document, arguments);
  if (arguments.ray) queryRay(document, arguments);
  if (arguments.box) queryBox(document, arguments);
  if (arguments.nearest) queryNearest(document, arguments);
}

void parseRay(const std::string& text, QueryArguments& arguments) {
  arguments.ray = parseNumbers<6>("--ray", text);
  const Eigen::Vector3d direction = vectorAt(*arguments.ray, 3);
  if (!(direction.norm() > 0) || !std::isfinite(direction.norm()))
    throw CLI::ValidationError("--ray", "'" + text + "' has no direction");
}

void parseBox(const std::string& text, QueryArguments& arguments) {
  arguments.box = parseNumbers<6>("--box", text);
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!((*arguments.box)[axis] <= (*arguments.box)[axis + 3]))
      throw CLI::ValidationError(
          "--box", "'" + text + "' is not a box: x0 <= x1, y0 <= y1 and z0 <= z1 must hold");
}

void parseMaxRange(const std::string& text, QueryArguments& arguments) {
  arguments.max_range = parseNumbers<1>("--max-range", text)[0];
  if (!(arguments.max_range > 0))
    throw CLI::ValidationError("--max-range", "'" + text + "' must be greater than 0");
}

}  // namespace

void addQueryCommand(CLI::App& program) {
  auto arguments = std::make_shared<QueryArguments>();
  CLI::App* command =
      program.add_subcommand("query", "Ask a map about a point, a ray, a box or a distance");
  command->add_option("MAP", arguments->file, "map file (.csom)")->required();
  CLI::Option* point = command->add_option_function<std::string>(
      "--point",
      [arguments](const std::string& text) { arguments->point = parseNumbers<3>("--point", text); },
      "the voxel at this point");
  CLI::Option* ray = command->add_option_function<std::string>(
      "--ray", [arguments](const std::string& text) { parseRay(text, *arguments); },
      "the first occupied voxel from an origin in a direction");
  CLI::Option* box = command->add_option_function<std::string>(
      "--box", [arguments](const std::string& text) { parseBox(text, *arguments); },
      "the known voxels whose centres lie in this box, by class");
  CLI::Option* nearest = command->add_option_function<std::string>(
      "--nearest",
      [arguments](const std::string& text) {
        arguments->nearest = parseNumbers<3>("--nearest", text);
      },
      "the distance from here to the nearest occupied voxel's centre");
  nearest->type_name("x,y,z")->excludes(point)->excludes(ray)->excludes(box);
  command
      ->add_option("--classes", arguments->classes,
                   "with --nearest: only voxels of these classes (names or ids)")
      ->delimiter(',')
      ->type_name("A,B")
      ->needs(nearest);
  point->type_name("x,y,z")->excludes(ray)->excludes(box);
  ray->type_name("ox,oy,oz,dx,dy,dz")->excludes(box);
  box->type_name("x0,y0,z0,x1,y1,z1");
  command
      ->add_option_function<std::string>(
          "--max-range", [arguments](const std::string& text) { parseMaxRange(text, *arguments); },
          "how far to follow the ray, or to look for the nearest voxel; without it, to the end "
          "of the map")
      ->type_name("METRES")
      ->excludes(point)
      ->excludes(box);
  command->add_flag("--json", arguments->json, "print JSON");
  command->footer(
      "Asks a map about one point, one ray, one box or one distance. Numbers are metres in the map "
      "frame.\n\n"
      "Examples:\n"
      "  csom query out/map.csom --point 12.3,-4,0.5\n"
      "  csom query out/map.csom --ray 0,0,1.7,1,0,0 --max-range 50\n"
      "  csom query out/map.csom --nearest 12.3,-4,0.5 --classes car,pole\n"
      "  csom query out/map.csom --box -5,-5,0,5,5,2 --json");
  command->callback([arguments] {
    if (!arguments->point && !arguments->ray && !arguments->box && !arguments->nearest)
      throw CLI::RequiredError("one of --point, --ray, --box, --nearest");
    runQuery(*arguments);
  });
}

}  // namespace csom
