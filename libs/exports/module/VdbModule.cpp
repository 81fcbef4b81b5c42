// SPDX-License-Identifier: BSD-3-Clause
// csom-vdb.so: grids of OpenVDB.
#include "VdbModule.h"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <string>

namespace csom::detail {
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

class Grids : public VdbGrids {
 public:
  explicit Grids(double resolution)
      : classes_(makeGrid<openvdb::Int32Grid>("class", resolution)),
        occupancy_(makeGrid<openvdb::FloatGrid>("occupancy", resolution)),
        variance_(makeGrid<openvdb::FloatGrid>("variance", resolution)),
        class_values_(classes_->getAccessor()),
        occupancy_values_(occupancy_->getAccessor()),
        variance_values_(variance_->getAccessor()) {}

  void add(std::int32_t x, std::int32_t y, std::int32_t z, int class_id, float occupancy,
           float variance) override {
    const openvdb::Coord at(x, y, z);
    class_values_.setValueOn(at, class_id);
    occupancy_values_.setValueOn(at, occupancy);
    variance_values_.setValueOn(at, variance);
  }

  void write(std::ostream& stream) const override {
    openvdb::io::Stream(stream).write(openvdb::GridCPtrVec{classes_, occupancy_, variance_});
  }

 private:
  openvdb::Int32Grid::Ptr classes_;
  openvdb::FloatGrid::Ptr occupancy_;
  openvdb::FloatGrid::Ptr variance_;
  openvdb::Int32Grid::Accessor class_values_;
  openvdb::FloatGrid::Accessor occupancy_values_;
  openvdb::FloatGrid::Accessor variance_values_;
};

}  // namespace
}  // namespace csom::detail

extern "C" void csomMakeVdbGrids(double resolution,
                                 std::unique_ptr<csom::detail::VdbGrids>& grids) {
  openvdb::initialize();
  grids = std::make_unique<csom::detail::Grids>(resolution);
}
