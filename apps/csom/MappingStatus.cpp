// SPDX-License-Identifier: BSD-3-Clause
// What a running `csom map` says about itself.
#include "MappingStatus.h"

#include <csom/report/Format.h>

namespace csom {

std::string mappingStatus(const MappingProgress& now, double seconds) {
  std::string text = formatCount(now.scans, "scan");
  if (seconds > 0) text += " (" + formatNumber(static_cast<double>(now.scans) / seconds) + "/s)";
  text += ", " + formatCount(now.map.knownVoxelCount(), "voxel") + " in " +
          formatBytes(now.map.memoryBytes());
  if (now.chunks_on_disk > 0)
    text += " and " + formatCount(now.chunks_on_disk, "chunk") + " on the disk";
  if (now.points_rejected > 0)
    text += ", " + formatCount(now.points_rejected, "point") + " rejected";
  if (now.observations_refused > 0)
    text += ", " + formatCount(now.observations_refused, "observation") + " refused";
  return text;
}

}  // namespace csom
