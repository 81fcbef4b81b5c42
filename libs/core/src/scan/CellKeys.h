// SPDX-License-Identifier: BSD-3-Clause
// Points keyed by the cell of a grid that each lies in.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "util/SortedKeys.h"

namespace csom::detail {

/// Cells of 2^shift steps of `edge` [m] a side, aligned with the map's origin. Points are relative
/// to `origin` and less than 2³⁰ steps from the map's.
struct CellGrid {
  Eigen::Vector3d origin;
  double edge;
  int shift;
};

/// Keys for the cells of all points.
KeyPacking makePacking(const CellGrid& cells, const std::vector<Eigen::Vector3f>& points);

/// Points by their cells: sorted by key, then in the order given. `Key` is 32 or 64 bits.
template <class Key>
std::vector<KeyedItem<Key>> sortedByCell(const CellGrid& cells, const KeyPacking& packing,
                                         const std::vector<Eigen::Vector3f>& points, int threads);

}  // namespace csom::detail
