// SPDX-License-Identifier: BSD-3-Clause
#include "scan/CellKeys.h"

#include <array>
#include <cmath>

#include "util/Lanes.h"

namespace csom::detail {

namespace {

/// Division, not multiplication by 1/edge: see Grid::indexOf().
CSOM_INLINE KeyPacking::Position cellOf(const CellGrid& cells, const Eigen::Vector3f& point) {
  // Three lanes of four: one division for all.
  using Four = double __attribute__((vector_size(4 * sizeof(double))));
  Four at{static_cast<double>(point.x()), static_cast<double>(point.y()),
          static_cast<double>(point.z()), 0};
  const Four origin{cells.origin.x(), cells.origin.y(), cells.origin.z(), 0};
  at = (origin + at) / cells.edge;
  KeyPacking::Position cell;
  for (std::size_t a = 0; a < 3; ++a)
    cell[a] = static_cast<std::int32_t>(std::floor(at[a])) >> cells.shift;
  return cell;
}

template <class Key>
CSOM_INLINE void pack(const CellGrid& cells, const KeyPacking& packing,
                      const Eigen::Vector3f* points, std::size_t begin, std::size_t end,
                      KeyedItem<Key>* items) {
  for (std::size_t i = begin; i < end; ++i)
    items[i] = {packing.pack<Key>(cellOf(cells, points[i])), static_cast<std::uint32_t>(i)};
}

CSOM_EVERY_PROCESSOR
void packAll(const CellGrid& cells, const KeyPacking& packing, const Eigen::Vector3f* points,
             std::size_t begin, std::size_t end, KeyedItem<std::uint32_t>* items) {
  pack(cells, packing, points, begin, end, items);
}
CSOM_EVERY_PROCESSOR
void packAll(const CellGrid& cells, const KeyPacking& packing, const Eigen::Vector3f* points,
             std::size_t begin, std::size_t end, KeyedItem<std::uint64_t>* items) {
  pack(cells, packing, points, begin, end, items);
}

}  // namespace

KeyPacking makePacking(const CellGrid& cells, const std::vector<Eigen::Vector3f>& points) {
  KeyPacking packing;
  if (!points.empty()) {
    Eigen::Array3f min = points.front();
    Eigen::Array3f max = min;
    for (const Eigen::Vector3f& point : points) {
      min = min.min(point.array());
      max = max.max(point.array());
    }
    // Sums, quotients and floors round monotonically: no cell lies outside of these two.
    packing.include(cellOf(cells, min));
    packing.include(cellOf(cells, max));
  }
  packing.finish();
  return packing;
}

template <class Key>
std::vector<KeyedItem<Key>> sortedByCell(const CellGrid& cells, const KeyPacking& packing,
                                         const std::vector<Eigen::Vector3f>& points, int threads) {
  std::vector<KeyedItem<Key>> items(points.size());
  parallelRanges(points.size(), threads, [&](std::size_t begin, std::size_t end) {
    packAll(cells, packing, points.data(), begin, end, items.data());
  });
  stableSort(items, packing.bits(), threads);
  return items;
}

template std::vector<KeyedItem<std::uint32_t>> sortedByCell(const CellGrid&, const KeyPacking&,
                                                            const std::vector<Eigen::Vector3f>&,
                                                            int);
template std::vector<KeyedItem<std::uint64_t>> sortedByCell(const CellGrid&, const KeyPacking&,
                                                            const std::vector<Eigen::Vector3f>&,
                                                            int);

}  // namespace csom::detail
