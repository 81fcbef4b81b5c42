// SPDX-License-Identifier: BSD-3-Clause
// A LiDAR that is carried along while it turns sees each direction from another place.
#pragma once

#include <csom/io/RunStatistics.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/poses/CPose3D.h>

#include <functional>
#include <optional>

namespace csom {

/// Where the robot is at a time [s since 1970], in a frame that does not move; nothing if unknown.
using RobotMotion = std::function<std::optional<mrpt::poses::CPose3D>(double time)>;

/// The same scan as if it had been taken at once at its time stamp: its points, moved, are in
/// point_cloud with their lasers and azimuths, and it has no packets (a MovedVelodyneScan). Null if
/// that is not needed or not possible; `statistics` says which. Also null, and nothing is counted,
/// for a scan without packets, which tells no times, and for one with a damaged packet, which the
/// map refuses.
mrpt::obs::CObservationVelodyneScan::Ptr deskewed(const mrpt::obs::CObservationVelodyneScan& scan,
                                                  const RobotMotion& motion,
                                                  DeskewStatistics& statistics);

/// When the last point of a scan was taken [s since 1970]; nothing for an observation whose packets
/// do not differ in time.
std::optional<double> sweepEnd(const mrpt::obs::CObservation& observation);

}  // namespace csom
