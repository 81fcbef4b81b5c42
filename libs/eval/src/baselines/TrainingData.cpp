// SPDX-License-Identifier: BSD-3-Clause
#include "baselines/TrainingData.h"

#include <csom/core/ScanPreparation.h>

#include <stdexcept>
#include <string>

namespace csom::detail {

TrainingData makeTrainingData(const Scan& scan, const Options& given, FreeSpace free_space) {
  if (scan.isSoft())
    throw std::invalid_argument("the compared methods take hard labels; this scan has soft ones");
  Options options = given;
  options.method = Method::SCsm;  // a block is then a voxel
  options.free_space.mode = free_space;
  ScanReport report;
  const PreparedScan prepared = prepareScan(scan, options, report);
  TrainingData data;
  data.origin = scan.origin;
  for (std::size_t b = 0; b < prepared.blocks.size(); ++b) {
    const Eigen::Vector3d corner(prepared.blocks[b].x, prepared.blocks[b].y, prepared.blocks[b].z);
    for (std::size_t i = prepared.block_begin[b]; i < prepared.block_begin[b + 1]; ++i) {
      const TrainingPoint& p = prepared.points[i];
      const Eigen::Vector3d point = options.resolution * (corner + Eigen::Vector3d(p.x, p.y, p.z));
      (p.label == kFreeClass ? data.free_points : data.hits).push_back(point);
    }
  }
  return data;
}

Options validInput(const Options& options) {
  Options input = options;
  if (input.free_space.mode != FreeSpace::None) input.free_space.mode = FreeSpace::Sampled;
  input.validate();
  return input;
}

void checkParameter(const char* name, double value, double min, double max) {
  if (value >= min && value <= max) return;  // false for NaN
  throw OptionError(std::string(name) + " = " + toString(value) + ": must be " + toString(min) +
                    " to " + toString(max));
}

}  // namespace csom::detail
