// SPDX-License-Identifier: BSD-3-Clause
// A map without files and without MRPT: scans in, points and rays asked.
#include <csom/core/SemanticMap.h>

#include <cstdio>

namespace {

constexpr csom::ClassId kRoad = 1;
constexpr csom::ClassId kWall = 2;

/// A road below the sensor and a wall 6 m in front of it, as a LiDAR would see them. Points are
/// relative to the sensor, with axes parallel to those of the map.
csom::Scan roadAndWall() {
  csom::Scan scan;
  scan.origin = {0, 0, 1.5};  // of the sensor, in the map frame [m]
  for (float y = -3; y <= 3; y += 0.1F) {
    for (float x = 2; x <= 6; x += 0.2F) {
      scan.points.emplace_back(x, y, -1.5F);
      scan.labels.push_back(kRoad);
    }
    for (float z = -1.4F; z <= 1; z += 0.1F) {
      scan.points.emplace_back(6.F, y, z);
      scan.labels.push_back(kWall);
    }
  }
  return scan;
}

}  // namespace

int main() {
  csom::Options options;
  options.number_of_classes = 3;  // class 0 is free space
  options.resolution = 0.2;       // edge of a voxel [m]
  options.free_space.mode = csom::FreeSpace::Raycast;
  csom::SemanticMap map(options);

  const csom::ScanReport report = map.insert(roadAndWall());
  std::printf("%zu points, %zu rejected; %zu voxels are known\n", report.points,
              report.rejectedTotal(), map.knownVoxelCount());

  const csom::DirichletVoxel road = map.at({4.0, 0.5, 0.05});
  std::printf("on the road: %s, %.2f road, %.2f wall\n", csom::toString(road.state()),
              road.probability(kRoad), road.probability(kWall));
  const csom::DirichletVoxel air = map.at({4.0, 0.5, 1.5});
  std::printf("in front of the wall: %s\n", csom::toString(air.state()));

  const auto hit = map.castRay({0, 0, 1.5}, {1, 0, 0}, 30);
  if (!hit) {
    std::printf("nothing ahead\n");
    return 1;
  }
  std::printf("ahead: class %d, %.1f m away\n", hit->class_id, hit->distance);
  const bool as_expected = road.mostLikelyClass() == kRoad && hit->class_id == kWall &&
                           air.state() == csom::VoxelState::Free;
  return as_expected ? 0 : 1;
}
