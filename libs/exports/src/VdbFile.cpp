// SPDX-License-Identifier: BSD-3-Clause
// A map as grids of OpenVDB.
#include <csom/core/Error.h>
#include <csom/exports/ExportChecks.h>
#include <csom/exports/VdbFile.h>
#include <csom/io/Module.h>
#include <csom/io/OutputFile.h>

#include <fstream>
#include <stdexcept>

#include "VdbModule.h"

namespace csom {
namespace {

std::unique_ptr<detail::VdbGrids> makeGrids(double resolution, const std::string& file) try {
  const auto make =
      detail::functionOfModule<detail::MakeVdbGrids>(detail::kVdbModule, detail::kMakeVdbGrids);
  std::unique_ptr<detail::VdbGrids> grids;
  make(resolution, grids);
  return grids;
} catch (const std::runtime_error& error) {
  throw ConfigError(file + ": " + error.what() +
                    ". It is built where libopenvdb-dev is installed; other formats do without");
}

}  // namespace

std::size_t writeVdb(const VoxelSelection& selection, const LabelSet& labels,
                     const std::string& file) {
  detail::checkExport(selection, labels);
  selection.requireResampledVoxels();
  OutputFile out(file);
  const auto grids = makeGrids(selection.resolution(), file);
  std::size_t count = 0;
  selection.withFreeVoxels(true).forEachResampled(
      [&](const VoxelIndex& v, const ExportedVoxel& voxel) {
        grids->add(v.x, v.y, v.z, voxel.class_id, static_cast<float>(voxel.occupancy),
                   static_cast<float>(voxel.variance));
        ++count;
      });

  std::ofstream stream(out.path(), std::ios::binary);
  try {
    grids->write(stream);
  } catch (const std::exception& error) {
    throw FileError(file, std::string("cannot be written: ") + error.what());
  }
  if (!stream.flush()) throw FileError(file, "cannot be written");
  stream.close();
  out.commit();
  return count;
}

}  // namespace csom
