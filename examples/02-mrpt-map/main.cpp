// SPDX-License-Identifier: BSD-3-Clause
// CSemanticContinuousMap in a program that works with MRPT's observations.
#include <csom/io/MapFile.h>
#include <csom/maps/CSemanticContinuousMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/poses/CPose3D.h>

#include <cstdio>
#include <fstream>

namespace {

/// The keys are those of MRPT's applications: docs/ini-reference.md of mrpt_csom lists all.
constexpr char kIni[] = R"(
[MappingApplication]
semanticContinuousMap_count = 1
[MappingApplication_semanticContinuousMap_00_creationOpts]
resolution = 0.1
[MappingApplication_semanticContinuousMap_00_insertOpts]
free_space = raycast
scan_2d_class = occupied
)";

/// A laser scanner in the middle of a round room with a radius of 3 m.
mrpt::obs::CObservation2DRangeScan roundRoom() {
  constexpr std::size_t kRays = 361;
  mrpt::obs::CObservation2DRangeScan scan;
  scan.aperture = static_cast<float>(2 * M_PI);
  scan.maxRange = 20;
  scan.resizeScan(kRays);
  for (std::size_t i = 0; i < kRays; ++i) {
    scan.setScanRange(i, 3);
    scan.setScanRangeValidity(i, true);
  }
  return scan;
}

}  // namespace

int main() {
  std::ofstream("room.ini") << kIni;
  const auto definition = csom::CSemanticContinuousMap::definitionFromIni("room.ini");
  csom::CSemanticContinuousMap map(definition);

  // The robot turns on the spot; any kind of observation with points is inserted alike.
  for (const double yaw : {0.0, 0.5, 1.0}) {
    const mrpt::poses::CPose3D robot(0, 0, 0.3, yaw, 0, 0);
    if (!map.insertObservation(roundRoom(), robot)) {
      std::printf("the observation was not used\n");
      return 1;
    }
  }

  const auto wall = map.map().nearestOccupied({2.5, 0, 0.3}, 2);
  std::printf("%zu scans; the wall is %.2f m away from (2.5, 0, 0.3)\n", map.scans().size(),
              wall ? wall->distance : -1);
  // The file that `csom info`, `query` and `export` read.
  csom::saveMap(map.document(), "room.csom");
  std::printf("wrote room.csom\n");
  return wall && wall->distance < 1 ? 0 : 1;
}
