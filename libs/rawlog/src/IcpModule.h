// SPDX-License-Identifier: BSD-3-Clause
// What csom-icp.so does for ScanRegistration: the library of MRPT's ICP brings along those of video
// and windows, a quarter of the time that the program would take to start.
#pragma once

#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/poses/CPose3D.h>

namespace csom::detail {

struct Alignment {
  mrpt::poses::CPose3D pose;  ///< of the points in the frame of the reference: expected, then found
  double first_distance;      ///< [m] between points that are paired, at first
  double last_distance;       ///< [m] at last
  double overlap;             ///< found: share of the points that have a partner
};

/// Lays `points` over `reference` with mrpt::slam::CICP. May throw what MRPT throws.
using AlignPoints = void(const mrpt::maps::CSimplePointsMap& reference,
                         const mrpt::maps::CSimplePointsMap& points, Alignment& alignment);

constexpr char kIcpModule[] = "csom-icp.so";
constexpr char kAlignPoints[] = "csomAlignPoints";

}  // namespace csom::detail
