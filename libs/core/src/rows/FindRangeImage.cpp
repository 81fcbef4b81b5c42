// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/FindRangeImage.h>

#include <stdexcept>
#include <string>

#include "rows/ColumnSteps.h"
#include "rows/Directions.h"
#include "rows/Lines.h"
#include "rows/Rows.h"

namespace csom {

namespace {

/// `row_of(i)`: that of beam i.
template <class RowOf>
RangeImage imageOf(std::size_t points, const detail::Directions& beams, const RowOf& row_of) {
  RangeImage image;
  image.columns_of_turn = detail::kColumnsOfTurn;
  image.pixels.resize(points);
  for (std::size_t i = 0; i < beams.size(); ++i)
    image.pixels[beams.point[i]] = {row_of(i), beams.azimuth[i]};
  return image;
}

}  // namespace

std::optional<RangeImage> findRangeImage(const std::vector<Eigen::Vector3f>& points) {
  const detail::Directions beams(points);
  for (const auto& find : {detail::findRowsInOrder, detail::findRowsByElevation}) {
    std::optional<detail::Rows> rows = find(beams);
    if (!rows || !detail::arrange(beams, *rows)) continue;
    RangeImage image =
        imageOf(points.size(), beams, [&](std::size_t i) { return rows->of_beam[i]; });
    const detail::ColumnSteps steps = detail::countColumnSteps(image);
    if (!detail::areEven(steps)) continue;
    image.column_step = detail::medianStep(steps);
    return image;
  }
  return detail::findLines(points);
}

RangeImage makeRangeImage(const std::vector<Eigen::Vector3f>& points,
                          const std::vector<std::uint16_t>& rows) {
  if (rows.size() != points.size())
    throw std::invalid_argument("a cloud of " + std::to_string(points.size()) + " points has " +
                                std::to_string(rows.size()) + " rows of them");
  const detail::Directions beams(points);
  RangeImage image =
      imageOf(points.size(), beams, [&](std::size_t i) { return rows[beams.point[i]]; });
  image.column_step = measureColumnStep(image);
  return image;
}

std::int32_t measureColumnStep(const RangeImage& image) {
  return detail::medianStep(detail::countColumnSteps(image));
}

}  // namespace csom
