// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>

#include "rows/Rows.h"

namespace csom::detail {

namespace {

constexpr std::int32_t kBin = 2;          // [0.01°]
constexpr std::int32_t kLowest = -9000;   // [0.01°]
constexpr std::size_t kBins = 9001;       // up to straight above
constexpr std::size_t kEmptyBetween = 2;  ///< bins that are empty by chance

std::size_t binOf(float elevation) {
  const auto above = static_cast<std::int32_t>(elevation - static_cast<float>(kLowest));
  return static_cast<std::size_t>(std::clamp(above / kBin, 0, static_cast<int>(kBins) - 1));
}

struct Band {
  std::size_t first;  ///< bin
  std::size_t last;
  std::size_t width() const { return last - first + 1; }
};

std::vector<Band> findBands(const std::array<std::uint32_t, kBins>& histogram) {
  const std::uint32_t most = *std::max_element(histogram.begin(), histogram.end());
  const std::uint32_t least = std::max<std::uint32_t>(4, most / 50);
  std::vector<Band> bands;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    if (histogram[bin] < least) continue;
    if (!bands.empty() && bin - bands.back().last <= kEmptyBetween + 1)
      bands.back().last = bin;
    else
      bands.push_back({bin, bin});
  }
  return bands;
}

/// Whether each band is narrow beside what is between it and the next.
bool areApart(const std::vector<Band>& bands) {
  for (std::size_t i = 1; i < bands.size(); ++i) {
    const std::size_t between = bands[i].first - bands[i - 1].last;
    if (2 * std::max(bands[i].width(), bands[i - 1].width()) > 3 * between) return false;
  }
  return true;
}

}  // namespace

std::optional<Rows> findRowsByElevation(const Directions& beams) {
  std::array<std::uint32_t, kBins> histogram{};
  for (const float elevation : beams.elevation) ++histogram[binOf(elevation)];
  const std::vector<Band> bands = findBands(histogram);
  if (bands.size() < kFewestRows || bands.size() > kMostRows || !areApart(bands))
    return std::nullopt;
  // Beams near to the sensor start beside its middle: they may be a little outside of the band.
  constexpr std::size_t kBeside = 2;
  std::vector<std::uint16_t> row_of_bin(kBins, Rows::kInNoRow);
  for (std::size_t row = 0; row < bands.size(); ++row) {
    const std::size_t first = bands[row].first - std::min(bands[row].first, kBeside);
    const std::size_t last = std::min(bands[row].last + kBeside, kBins - 1);
    std::fill(row_of_bin.begin() + static_cast<std::ptrdiff_t>(first),
              row_of_bin.begin() + static_cast<std::ptrdiff_t>(last + 1),
              static_cast<std::uint16_t>(row));
  }
  Rows rows;
  rows.count = bands.size();
  rows.of_beam.reserve(beams.size());
  for (const float elevation : beams.elevation)
    rows.of_beam.push_back(row_of_bin[binOf(elevation)]);
  return rows;
}

}  // namespace csom::detail
