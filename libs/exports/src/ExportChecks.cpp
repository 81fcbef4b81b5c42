// SPDX-License-Identifier: BSD-3-Clause
// What must hold before an export begins.
#include <csom/exports/ExportChecks.h>

#include <csom/core/Error.h>

#include <cmath>
#include <stdexcept>

namespace csom::detail {

void checkExport(const VoxelSelection& voxels, const LabelSet& labels) {
  if (voxels.map().options().number_of_classes != labels.numberOfClasses())
    throw std::invalid_argument("export: the map and the label set differ in classes");
  voxels.requireVoxels();
}

void checkSinglePrecision(const Eigen::Vector3d& point, double resolution) {
  const double farthest = point.cwiseAbs().maxCoeff();
  // Rounding to 24 bits.
  if (std::ldexp(farthest, -24) > resolution / 2)
    throw ConfigError(
        "a voxel lies " + toString(std::round(farthest)) +
            " m from the origin, too far for the single precision of this format; move "
            "it nearer, or export to ply",
        {"frame"});
}

void requireRegularFile(const OutputFile& file, const std::string& target) {
  if (file.isDirect())
    throw FileError(target, "is no regular file, which this format needs; name a file");
}

}  // namespace csom::detail
