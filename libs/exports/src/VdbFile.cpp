// SPDX-License-Identifier: BSD-3-Clause
// A map as grids of OpenVDB.
#include <csom/core/Error.h>
#include <csom/exports/ExportChecks.h>
#include <csom/exports/VdbFile.h>
#include <csom/io/OutputFile.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <fstream>

namespace csom {
namespace {

template <class Grid>
typename Grid::Ptr makeGrid(const std::string& name, double resolution) {
  auto grid = Grid::create();
  grid->setName(name);
  auto transform = openvdb::math::Transform::createLinearTransform(resolution);
  transform->postTranslate(openvdb::Vec3d(resolution / 2));
  grid->setTransform(transform);
  return grid;
}

}  // namespace

std::size_t writeVdb(const VoxelSelection& selection, const LabelSet& labels,
                     const std::string& file) {
  detail::checkExport(selection, labels);
  OutputFile out(file);
  openvdb::initialize();
  const auto classes = makeGrid<openvdb::Int32Grid>("class", selection.resolution());
  const auto occupancy = makeGrid<openvdb::FloatGrid>("occupancy", selection.resolution());
  const auto variance = makeGrid<openvdb::FloatGrid>("variance", selection.resolution());
  auto class_values = classes->getAccessor();
  auto occupancy_values = occupancy->getAccessor();
  auto variance_values = variance->getAccessor();
  std::size_t count = 0;
  selection.withFreeVoxels(true).forEachResampled(
      [&](const VoxelIndex& v, const ExportedVoxel& voxel) {
        const openvdb::Coord at(v.x, v.y, v.z);
        class_values.setValueOn(at, voxel.class_id);
        occupancy_values.setValueOn(at, static_cast<float>(voxel.occupancy));
        variance_values.setValueOn(at, static_cast<float>(voxel.variance));
        ++count;
      });

  std::ofstream stream(out.path(), std::ios::binary);
  try {
    openvdb::io::Stream(stream).write(openvdb::GridCPtrVec{classes, occupancy, variance});
  } catch (const openvdb::Exception& error) {
    throw FileError(file, std::string("cannot be written: ") + error.what());
  }
  if (!stream.flush()) throw FileError(file, "cannot be written");
  stream.close();
  out.commit();
  return count;
}

}  // namespace csom
