// SPDX-License-Identifier: BSD-3-Clause
// The packets of a Velodyne LiDAR, beam by beam.
#pragma once

#include <csom/maps/PointExtractor.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace csom {

/// What one laser measured at one firing.
struct VelodyneBeam {
  Eigen::Vector3f point;   ///< in the frame of the sensor [m], or a direction of length 1:
  bool returned;           ///< false: nothing came back from there
  std::uint8_t intensity;  ///< as written
  std::uint8_t laser;      ///< an index of the calibration
  std::uint16_t azimuth;   ///< clockwise from the x axis, 0 … 35999 [0.01°]
  float seconds;           ///< since the first packet
};

/// All beams of a scan's packets, those without a return too, in the order in which they were
/// fired. Returns beyond maxRange of the scan count as none. Of a
/// dual return that differs, the second follows as a beam of its own; of one that does not, there
/// is one.
///
/// Angles and offsets are those of the scan's calibration: 16 lasers (VLP-16; both firings of each
/// block), 32 (HDL-32E), or 64 (HDL-64E, of which a block counts as fired at once).
/// generatePointCloud() of MRPT 2.5 reads 16 beams of each block, half of them, and neither turns
/// lasers as their calibration has it nor moves them to the right side.
///
/// Throws std::runtime_error if the calibration has another number of lasers, or if a packet is
/// damaged.
std::vector<VelodyneBeam> decodePackets(const mrpt::obs::CObservationVelodyneScan& scan);

/// When a packet was sent, from the first one of its scan on [s]: the hour may end between them.
double secondsSinceFirst(const mrpt::obs::CObservationVelodyneScan& scan, std::size_t packet);

/// Of each laser of a calibration the row that it measures: 0 is the lowest.
std::vector<std::uint16_t> rowsOfLasers(const mrpt::obs::VelodyneCalibration& calibration);

/// A scan without packets whose points are those of its packets, moved. MRPT writes it as what it
/// is derived from, without what a cloud cannot say.
struct MovedVelodyneScan : mrpt::obs::CObservationVelodyneScan {
  std::vector<EmptyBeam> empty_beams;
  std::size_t too_near = 0;  ///< beams that something nearer than minRange has thrown back
};

}  // namespace csom
