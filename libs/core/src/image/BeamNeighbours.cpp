// SPDX-License-Identifier: BSD-3-Clause
#include "image/BeamNeighbours.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "util/Parallel.h"

namespace csom::detail {

namespace {

/// A beam is missing between two of a row that are farther apart, in tenths of a column step.
constexpr std::int64_t kNextTenths = 16;
/// Beams of adjacent rows lie side by side if they are nearer.
constexpr std::int64_t kAboveTenths = 8;

/// By insertion, as long as most are in order.
template <class Iterator, class Before>
void sortNearlySorted(Iterator first, Iterator last, const Before& before) {
  auto moves = 4 * (last - first);
  for (Iterator i = first; i != last; ++i) {
    const auto item = *i;
    Iterator to = i;
    for (; to != first && before(item, *(to - 1)); --to) *to = *(to - 1);
    *to = item;
    moves -= i - to;
    if (moves < 0) {
      std::sort(first, last, before);
      return;
    }
  }
}

/// Lists the beams row by row and finds what lies beside them.
class Arrangement {
 public:
  Arrangement(const RangeImage& image, BeamNeighbours& out) : image_(image), out_(out) {}

  void run(int threads) {
    sortByRow();
    const std::size_t rows = out_.row_begin.size() - 1;
    const std::size_t beams = out_.point.size();
    for (std::vector<BeamId>* side : {&out_.next, &out_.previous, &out_.above, &out_.below})
      side->assign(beams, kNoBeam);
    parallelRanges(rows, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row) {
        linkRow(row);
        if (row + 1 < rows) linkRows(row, row + 1, out_.above);
        if (row > 0) linkRows(row, row - 1, out_.below);
      }
    });
  }

 private:
  std::int64_t columnOf(std::size_t beam) const { return out_.columns[beam]; }
  bool isNear(std::int64_t columns, std::int64_t tenths) const {
    return 10 * columns < tenths * image_.column_step;
  }

  /// Counts, then sorts within the rows, most of which are in order already.
  void sortByRow() {
    const std::vector<RangeImage::Pixel>& pixels = image_.pixels;
    std::size_t rows = 0;
    for (const RangeImage::Pixel& pixel : pixels)
      if (pixel.row != RangeImage::kNoRow) rows = std::max<std::size_t>(rows, pixel.row + 1U);
    std::vector<std::uint32_t> begin(rows + 1, 0);
    for (const RangeImage::Pixel& pixel : pixels)
      if (pixel.row != RangeImage::kNoRow) ++begin[pixel.row + 1U];
    for (std::size_t row = 0; row < rows; ++row) begin[row + 1] += begin[row];
    std::vector<std::uint32_t>& points = out_.points;
    points.resize(begin[rows]);
    std::vector<std::uint32_t> end(begin.begin(), begin.end() - 1);
    for (std::uint32_t i = 0; i < pixels.size(); ++i)
      if (pixels[i].row != RangeImage::kNoRow) points[end[pixels[i].row]++] = i;

    const auto before = [&](std::uint32_t a, std::uint32_t b) {
      return pixels[a].column != pixels[b].column ? pixels[a].column < pixels[b].column : a < b;
    };
    out_.row_begin.assign(1, 0);
    out_.point.clear();
    out_.columns.clear();
    for (std::size_t row = 0; row < rows; ++row) {
      const auto first = points.begin() + begin[row];
      const auto last = points.begin() + begin[row + 1];
      std::rotate(first, beginOfTurn(first, last), last);
      sortNearlySorted(first, last, before);
      for (auto point = first; point != last; ++point) {
        const std::int32_t column = pixels[*point].column;
        if (out_.point.size() > out_.row_begin.back() && out_.columns.back() == column) continue;
        out_.point.push_back(*point);
        out_.columns.push_back(column);
      }
      out_.row_begin.push_back(static_cast<std::uint32_t>(out_.point.size()));
    }
  }

  /// A turn may begin at any column: the point behind the one from which it goes back the most, if
  /// that is more than half a turn.
  template <class Iterator>
  Iterator beginOfTurn(Iterator first, Iterator last) const {
    const auto column = [&](Iterator point) { return std::int64_t{image_.pixels[*point].column}; };
    Iterator begin = first;
    std::int64_t most = image_.columns_of_turn / 2;
    for (Iterator i = first; i != last; ++i) {
      if (i == first || column(i - 1) - column(i) <= most) continue;
      most = column(i - 1) - column(i);
      begin = i;
    }
    return begin;
  }

  void linkRow(std::size_t row) const {
    const std::size_t begin = out_.row_begin[row];
    const std::size_t end = out_.row_begin[row + 1];
    const auto link = [&](std::size_t beam, std::size_t next, std::int64_t columns) {
      if (!isNear(columns, kNextTenths)) return;
      out_.next[beam] = static_cast<BeamId>(next);
      out_.previous[next] = static_cast<BeamId>(beam);
    };
    for (std::size_t beam = begin; beam + 1 < end; ++beam)
      link(beam, beam + 1, columnOf(beam + 1) - columnOf(beam));
    if (image_.columns_of_turn > 0 && end > begin + 1)
      link(end - 1, begin, columnOf(begin) + image_.columns_of_turn - columnOf(end - 1));
  }

  /// For each beam of `row` the beam of `other` beside it.
  void linkRows(std::size_t row, std::size_t other, std::vector<BeamId>& links) const {
    const std::int64_t begin = out_.row_begin[other];
    const std::int64_t end = out_.row_begin[other + 1];
    if (begin == end) return;
    const std::int32_t* const columns = out_.columns.data();
    // The ends of the row once more, a turn before and behind it.
    const std::int64_t turn = image_.columns_of_turn;
    const std::int64_t none = std::numeric_limits<std::int64_t>::max() / 2;
    const std::int64_t first_again = turn > 0 ? columns[begin] + turn : none;
    const std::int64_t last_before = turn > 0 ? columns[end - 1] - turn : -none;
    std::int64_t nearest = begin;
    std::int64_t behind = begin + 1 < end ? columns[begin + 1] : none;
    for (std::size_t beam = out_.row_begin[row]; beam < out_.row_begin[row + 1]; ++beam) {
      const std::int64_t column = columns[beam];
      std::int64_t distance = std::abs(columns[nearest] - column);
      while (std::abs(behind - column) < distance) {
        distance = std::abs(behind - column);
        ++nearest;
        behind = nearest + 1 < end ? columns[nearest + 1] : none;
      }
      std::int64_t best = nearest;
      if (first_again - column < distance) {
        best = begin;
        distance = first_again - column;
      }
      if (column - last_before < distance) {
        best = end - 1;
        distance = column - last_before;
      }
      if (isNear(distance, kAboveTenths)) links[beam] = static_cast<BeamId>(best);
    }
  }

  const RangeImage& image_;
  BeamNeighbours& out_;
};

}  // namespace

void BeamNeighbours::find(const RangeImage& image, int threads) {
  Arrangement(image, *this).run(threads);
}

}  // namespace csom::detail
