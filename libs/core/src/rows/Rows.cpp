// SPDX-License-Identifier: BSD-3-Clause
#include "rows/Rows.h"

#include <algorithm>
#include <utility>

#include "util/Median.h"

namespace csom::detail {

namespace {

/// The elevation of a row and its number.
using RowElevation = std::pair<float, std::size_t>;

/// Whether rows lie over one another, as those of several turns do.
bool areDoubled(std::vector<RowElevation> rows) {
  std::sort(rows.begin(), rows.end());
  std::vector<float> gaps;
  for (std::size_t i = 1; i < rows.size(); ++i) gaps.push_back(rows[i].first - rows[i - 1].first);
  const float apart = medianOf(gaps);
  const auto same = static_cast<std::size_t>(
      std::count_if(gaps.begin(), gaps.end(), [&](float gap) { return gap < 0.25F * apart; }));
  return apart <= 0 || 10 * same > gaps.size();
}

/// From the lowest up. Rows that were written down in the order of their lasers keep that one:
/// lasers are not mounted in one place, what is near is seen a little out of order.
void sortUpwards(std::vector<RowElevation>& rows) {
  std::size_t up = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) up += rows[i].first > rows[i - 1].first ? 1 : 0;
  const std::size_t pairs = rows.size() - 1;
  if (10 * up <= pairs)
    std::reverse(rows.begin(), rows.end());
  else if (10 * up < 9 * pairs)
    std::sort(rows.begin(), rows.end());
}

}  // namespace

bool arrange(const Directions& beams, Rows& rows) {
  std::vector<std::vector<float>> elevations(rows.count);
  for (std::size_t i = 0; i < beams.size(); ++i)
    if (rows.of_beam[i] != Rows::kInNoRow)
      elevations[rows.of_beam[i]].push_back(beams.elevation[i]);
  std::vector<RowElevation> order;
  std::size_t in_rows = 0;
  for (std::size_t row = 0; row < rows.count; ++row) {
    if (elevations[row].size() < kFewestBeamsOfRow) continue;
    in_rows += elevations[row].size();
    order.emplace_back(medianOf(elevations[row]), row);
  }
  if (order.size() < kFewestRows || order.size() > kMostRows || 10 * in_rows < 9 * beams.size())
    return false;
  if (areDoubled(order)) return false;
  sortUpwards(order);
  std::vector<std::uint16_t> number(rows.count, Rows::kInNoRow);
  for (std::size_t i = 0; i < order.size(); ++i)
    number[order[i].second] = static_cast<std::uint16_t>(i);
  for (std::uint16_t& row : rows.of_beam)
    if (row != Rows::kInNoRow) row = number[row];
  rows.count = order.size();
  return true;
}

}  // namespace csom::detail
