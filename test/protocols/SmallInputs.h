// SPDX-License-Identifier: BSD-3-Clause
// Inputs of the protocols, small enough to know what must come out.
#pragma once

#include <csom/io/LabelSet.h>
#include <csom/protocols/RoomProtocols.h>

#include <string>

#include "TestFiles.h"

namespace csom::test {

inline LabelSet labelsOf(const std::string& name) {
  return LabelSet::load(CSOM_SOURCE_DIR "/config/labels/" + name + ".yaml");
}

/// A wall (1) of 40 × 20 voxels of 0.05 m and a table (3) of 10 × 10, four points in each voxel,
/// none near its border.
inline Room smallRoom() {
  Room room;
  room.labels = labelsOf("stanford");
  const auto addVoxel = [](LabelledCloud& cloud, int x, int y, int z, ClassId label) {
    for (const double a : {0.3, 0.7})
      for (const double b : {0.3, 0.7})
        cloud.add(0.05 * Eigen::Vector3d(x + a, y + b, z + (a + b) / 2), label);
  };
  LabelledCloud& wall = room.clouds.emplace_back();
  for (int x = 0; x < 40; ++x)
    for (int z = 0; z < 20; ++z) addVoxel(wall, x, 0, z, 1);
  LabelledCloud& table = room.clouds.emplace_back();
  for (int x = 0; x < 10; ++x)
    for (int y = 10; y < 20; ++y) addVoxel(table, x, y, 8, 3);
  return room;
}

inline std::string pcdFile(const std::string& rows, int points) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F U\n"
         "COUNT 1 1 1 1\nWIDTH " +
         std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
         std::to_string(points) + "\nDATA ascii\n" + rows;
}

/// A closed room of 3 × 2 × 1.5 m seen from two places, with `sensors` (lines of YAML).
inline std::string smallWorld(const TempFolder& folder, const std::string& sensors) {
  const std::string file = folder / "world.yaml";
  writeBytes(
      file, "label_set: " CSOM_SOURCE_DIR
            "/config/labels/simulator.yaml\n"
            "seed: 5\ntruth: {resolution: 0.1, min: [0, 0, 0], max: [3, 2, 1.5]}\n"
            "robot: {stations: [[2, 1, 90], [1, 1, 0]], dwell: 1}\n"
            "sensors:\n" +
                sensors +
                "solids:\n"
                "  - {shape: box, class: floor, center: [1.5, 1, 0], size: [3.2, 2.2, 0.1]}\n"
                "  - {shape: box, class: ceiling, center: [1.5, 1, 1.5], size: [3.2, 2.2, 0.1]}\n"
                "  - {shape: box, class: wall, center: [0, 1, 0.75], size: [0.1, 2.2, 1.6]}\n"
                "  - {shape: box, class: wall, center: [3, 1, 0.75], size: [0.1, 2.2, 1.6]}\n"
                "  - {shape: box, class: wall, center: [1.5, 0, 0.75], size: [3.2, 0.1, 1.6]}\n"
                "  - {shape: box, class: wall, center: [1.5, 2, 0.75], size: [3.2, 0.1, 1.6]}\n"
                "  - {shape: box, class: table, center: [2.4, 0.5, 0.4], size: [0.5, 0.3, 0.1]}\n");
  return file;
}

constexpr char kPointSampler[] =
    "  - {type: point_sampler, label: scanner, pose: [0, 0, 0.8, 0, 0, 0], rate: 1, points: 1500, "
    "range: [0.1, 5]}\n";
constexpr char kCamera[] =
    "  - {type: camera, label: camera, pose: [0, 0, 0.8, 0, 0, 0], rate: 1, width: 80, height: 60, "
    "horizontal_fov_deg: 90}\n";

}  // namespace csom::test
