// SPDX-License-Identifier: BSD-3-Clause
// What the compared methods are trained on: the very points that the library's own map gets.
#pragma once

#include <csom/core/Options.h>
#include <csom/core/types.h>

#include <Eigen/Core>
#include <vector>

namespace csom::detail {

/// Map frame, metres.
struct TrainingData {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of the sensor
  std::vector<Eigen::Vector3d> hits;
  std::vector<Eigen::Vector3d> free_points;  ///< of class 0: given in the scan, or sampled
};

/// Rejects and down-samples as `options` say, and samples beams if `free_space` is Sampled. Throws
/// std::invalid_argument if labels and points differ in number, or for soft labels.
TrainingData makeTrainingData(const Scan& scan, const Options& options, FreeSpace free_space);

/// `options` with which the beams of a scan are free space, unless there is to be none. Throws
/// OptionError.
Options validInput(const Options& options);

/// Throws OptionError, with the name of the parameter, unless min ≤ value ≤ max.
void checkParameter(const char* name, double value, double min, double max);

}  // namespace csom::detail
