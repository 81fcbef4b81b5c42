// SPDX-License-Identifier: BSD-3-Clause
// P4, P5 and P8: simulated worlds, whose truth is exact.
#pragma once

#include <csom/eval/Scenario.h>
#include <csom/protocols/Trial.h>

#include <vector>

namespace csom {

/// P4: the sensors of the scenario label their points themselves; free space as the paper samples
/// it. Throws ConfigError and FileError as simulateRawlog() does.
std::vector<Trial> structuredRoomTrials(const Scenario& scenario);

/// P5: each camera of the scenario labels the points of the other sensors by its images of class
/// ids, and nothing else does; once with the true poses and once with the odometry of the scenario.
/// Throws ConfigError if the scenario has no camera.
std::vector<Trial> robotTrials(const Scenario& scenario);

/// P8: the LiDAR of the scenario labels its points itself, true poses, one training point a voxel
/// for methods that thin scans out; the truth is that of what
/// stays, and voxels are asked about once they were in clear sight (Sight.h). Throws ConfigError if
/// nothing moves, and as planSightChecks() does.
std::vector<Trial> movingTrials(const Scenario& scenario);

}  // namespace csom
