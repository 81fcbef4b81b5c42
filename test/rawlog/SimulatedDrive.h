// SPDX-License-Identifier: BSD-3-Clause
// A yard to drive through, for tests that need scans of a world whose truth is known.
#pragma once

#include <csom/eval/Scenario.h>

#include <string>

#include "io/IoFixtures.h"

namespace csom::test {

/// 8 m along x at 4 m/s past walls, a pole, a car and a tree, in front of a VLP-16 `lidar` with
/// these further keys.
inline Scenario yardDrive(const TempFolder& folder, const std::string& lidar_keys = "") {
  const std::string file = folder / "yard.yaml";
  writeBytes(file,
             "label_set: " CSOM_SOURCE_DIR
             "/config/labels/simulator.yaml\n"
             "seed: 3\ntruth: {resolution: 1, min: [0, 0, 0], max: [1, 1, 1]}\n"
             "robot: {waypoints: [[-8, 0], [0, 0]], turn_radius: 1, speed: 4}\n"
             "sensors:\n"
             "  - {type: velodyne_vlp16, label: lidar, pose: [0.2, 0.1, 1.5, 40, 2, -1], rate: 10, "
             "range: [1, 60]" +
                 lidar_keys +
                 "}\n"
                 "solids:\n"
                 "  - {shape: ground, class: terrain, center: [0, 0, 0], size: [40, 40]}\n"
                 "  - {shape: box, class: wall, center: [20, 0, 2], size: [1, 41, 5]}\n"
                 "  - {shape: box, class: building, center: [-20, 0, 2], size: [1, 41, 5]}\n"
                 "  - {shape: box, class: fence, center: [0, 20, 2], size: [41, 1, 5]}\n"
                 "  - {shape: box, class: wall, center: [0, -20, 2], size: [41, 1, 5]}\n"
                 "  - {shape: cylinder, class: pole, center: [5, 3, 2], radius: 0.3, height: 4}\n"
                 "  - {shape: box, class: car, center: [6, -5, 0.8], size: [4, 2, 1.4]}\n"
                 "  - {shape: sphere, class: vegetation, center: [-6, 4, 2], radius: 1.5}\n");
  return loadScenario(file);
}

}  // namespace csom::test
