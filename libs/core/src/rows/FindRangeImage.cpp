// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/FindRangeImage.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "rows/Directions.h"
#include "rows/Lines.h"
#include "rows/RowColumns.h"
#include "rows/Rows.h"

namespace csom {

std::optional<RangeImage> findRangeImage(const std::vector<Eigen::Vector3f>& points) {
  const detail::Directions beams(points);
  for (const auto& find : {detail::findRowsInOrder, detail::findRowsByElevation}) {
    std::optional<detail::Rows> rows = find(beams);
    if (!rows || !detail::arrange(beams, *rows) || !detail::areEvenlySpaced(beams, *rows)) continue;
    RangeImage image;
    image.columns_of_turn = detail::kColumnsOfTurn;
    image.pixels.resize(points.size());
    for (std::size_t i = 0; i < beams.size(); ++i)
      image.pixels[beams.point[i]] = {rows->of_beam[i], beams.azimuth[i]};
    image.column_step = measureColumnStep(image);
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
  RangeImage image;
  image.columns_of_turn = detail::kColumnsOfTurn;
  image.pixels.resize(points.size());
  for (std::size_t i = 0; i < beams.size(); ++i)
    image.pixels[beams.point[i]] = {rows[beams.point[i]], beams.azimuth[i]};
  image.column_step = measureColumnStep(image);
  return image;
}

std::int32_t measureColumnStep(const RangeImage& image) {
  std::size_t rows = 0;
  for (const RangeImage::Pixel& pixel : image.pixels)
    if (pixel.row != RangeImage::kNoRow) rows = std::max<std::size_t>(rows, pixel.row + 1U);
  detail::RowColumns columns(rows);
  for (const RangeImage::Pixel& pixel : image.pixels)
    if (pixel.row != RangeImage::kNoRow) columns.add(pixel.row, pixel.column);
  return detail::medianStep(columns.countSteps());
}

}  // namespace csom
