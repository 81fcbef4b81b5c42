// SPDX-License-Identifier: BSD-3-Clause
// Where the sensors of a run went.
#pragma once

#include <csom/report/RunRecord.h>

#include <Eigen/Core>
#include <vector>

namespace csom {

/// The ways of the sensors [m], map frame: a line each, a new one wherever the sensor jumps, as it
/// does between logs. A sensor that stood still gives a line of one point. At most some thousand
/// points altogether.
std::vector<std::vector<Eigen::Vector3d>> trajectories3d(const RunRecord& record);

}  // namespace csom
