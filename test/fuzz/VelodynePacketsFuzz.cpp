// SPDX-License-Identifier: BSD-3-Clause
// Packets of a Velodyne, and the rows that are found in the cloud of their points: the first byte
// chooses the number of lasers.
#include <csom/core/FindRangeImage.h>
#include <csom/maps/VelodynePackets.h>

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "FuzzTarget.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  mrpt::obs::CObservationVelodyneScan scan;
  const std::size_t lasers = std::size_t{16} << data[0] % 4U;  // 128 of them are refused
  scan.calibration.laser_corrections.resize(lasers);
  for (std::size_t i = 0; i < lasers; ++i) {
    const double sine = 0.01 * static_cast<double>(i) - 0.3;
    scan.calibration.laser_corrections[i].sinVertCorrection = sine;
    scan.calibration.laser_corrections[i].cosVertCorrection = std::sqrt(1 - sine * sine);
  }
  scan.scan_packets.resize((size - 1) / sizeof scan.scan_packets[0]);
  if (!scan.scan_packets.empty())
    std::memcpy(static_cast<void*>(scan.scan_packets.data()), data + 1,
                scan.scan_packets.size() * sizeof scan.scan_packets[0]);
  try {
    std::vector<Eigen::Vector3f> points;
    for (const csom::VelodyneBeam& beam : csom::decodePackets(scan))
      points.push_back(beam.returned ? beam.point : Eigen::Vector3f(0, 0, 0));
    csom::findRangeImage(points);
  } catch (const std::runtime_error&) {
    // As it should be.
  }
  return 0;
}
