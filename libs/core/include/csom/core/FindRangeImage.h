// SPDX-License-Identifier: BSD-3-Clause
// The range image of a cloud that does not tell it.
#pragma once

#include <csom/core/RangeImage.h>

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

namespace csom {

/// Finds the rows of a cloud that one rotating sensor has measured in one turn (or part of it), or
/// one that looks along a grid of directions.
///
/// `points`: relative to the sensor, the z axis being that of its rotation [m], as they were
/// written down: row after row, each in the order of azimuths, as KITTI and organised clouds are;
/// in any order if each row has an elevation of its own, as clouds of Velodyne drivers have; or
/// line after line of a grid, rows or columns of it. Beams that returned nothing may be among them,
/// as (0,0,0) or non-finite, and must be in a grid: they get no row.
///
/// Columns are hundredths of a degree, from the x axis to the y axis; those of a grid are numbered.
/// Nothing if the points are not such a scan: those of several scans, too few (less than four rows
/// of at least 16, or lines of four), or in no such order.
///
/// Rows are found, not guessed: what is returned has passed the checks of docs/algorithm.md. The
/// same on every processor. Thread-safe.
std::optional<RangeImage> findRangeImage(const std::vector<Eigen::Vector3f>& points);

/// The image of a cloud whose rows are known, one a point, RangeImage::kNoRow for none: columns as
/// above. Throws std::invalid_argument if there is another number of rows than points.
RangeImage makeRangeImage(const std::vector<Eigen::Vector3f>& points,
                          const std::vector<std::uint16_t>& rows);

/// The columns between adjacent beams of a row: the median. 1 if no two points share a row.
std::int32_t measureColumnStep(const RangeImage& image);

}  // namespace csom
