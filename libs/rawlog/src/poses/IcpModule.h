// SPDX-License-Identifier: BSD-3-Clause
// What csom-icp.so does for ScanRegistration: the library of MRPT's ICP brings along those of video
// and windows, a quarter of the time that the program would take to start.
#pragma once

#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/poses/CPose3D.h>

namespace csom::detail {

/// [m] between where points are expected and where they fit; ICP begins by pairing points so far
/// apart.
constexpr double kLargestCorrection = 3;

struct Alignment {
  mrpt::poses::CPose3D pose;  ///< of the points in the frame of the reference
  double overlap = 0;         ///< share of the points that have a partner
};

/// Lays `points`, `expected` in the frame of `reference`, over it with mrpt::slam::CICP. May throw
/// what MRPT throws.
using AlignPoints = void(const mrpt::maps::CSimplePointsMap& reference,
                         const mrpt::maps::CSimplePointsMap& points,
                         const mrpt::poses::CPose3D& expected, Alignment& found);

constexpr char kIcpModule[] = "csom-icp.so";
constexpr char kAlignPoints[] = "csomAlignPoints";

}  // namespace csom::detail
