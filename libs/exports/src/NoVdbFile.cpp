// SPDX-License-Identifier: BSD-3-Clause
// What stands for VdbFile.cpp where there was no OpenVDB at build time.
#include <csom/core/Error.h>
#include <csom/exports/VdbFile.h>

namespace csom {

std::size_t writeVdb(const VoxelSelection&, const LabelSet&, const std::string& file) {
  throw ConfigError(
      file +
      ": this build has no OpenVDB; install libopenvdb-dev and build again, or export "
      "to another format");
}

}  // namespace csom
