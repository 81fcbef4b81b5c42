// SPDX-License-Identifier: BSD-3-Clause
// What a mapping run tells its user beside its figures.
#pragma once

#include <csom/rawlog/MappingRun.h>

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

namespace csom::detail {

/// "3 scans".
std::string counted(std::size_t count, const std::string& things);

/// What is worth a word of the points and cameras of a run that is done, a line each.
/// `farthest_pose`: the robot's position with the largest coordinate [m].
std::vector<std::string> warningsAbout(const CSemanticContinuousMap& map,
                                       const Eigen::Vector3d& farthest_pose);

/// Why a run has put nothing into its map, one line.
std::string whyEmpty(const MappingRequest& request, const MappingResult& result);

}  // namespace csom::detail
