// SPDX-License-Identifier: BSD-3-Clause
// What csom-vdb.so does for writeVdb(): OpenVDB and the libraries it needs are a quarter of the
// time that the program would take to start.
#pragma once

#include <cstdint>
#include <memory>
#include <ostream>

namespace csom::detail {

/// The grids `class`, `occupancy` and `variance` of one file.
class VdbGrids {
 public:
  virtual ~VdbGrids() = default;

  virtual void add(std::int32_t x, std::int32_t y, std::int32_t z, int class_id, float occupancy,
                   float variance) = 0;

  /// Throws std::exception.
  virtual void write(std::ostream& stream) const = 0;
};

/// Edge length `resolution` [m]; voxel (0, 0, 0) begins at the origin.
using MakeVdbGrids = void(double resolution, std::unique_ptr<VdbGrids>& grids);

constexpr char kVdbModule[] = "csom-vdb.so";
constexpr char kMakeVdbGrids[] = "csomMakeVdbGrids";

}  // namespace csom::detail
