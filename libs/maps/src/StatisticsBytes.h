// SPDX-License-Identifier: BSD-3-Clause
// Statistics as bytes, by name, so that a later version may add figures.
#pragma once

#include <csom/core/Statistic.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>

#include "ByteStream.h"

namespace csom {

/// Names of figures inside each other are joined by dots.
template <class Statistics>
void collectFigures(const Statistics& statistics, const std::string& prefix,
                    std::map<std::string, double>& figures) {
  Statistics::visit(
      [&](const StatisticInfo& info, const auto& field) {
        if constexpr (IsStatistics<std::decay_t<decltype(field)>>::value)
          collectFigures(field, prefix + info.key + ".", figures);
        else
          figures[prefix + info.key] = static_cast<double>(field);
      },
      statistics);
}

/// Throws std::runtime_error if `Figure`, which is called `name`, cannot have that value.
template <class Figure>
Figure toFigure(const std::string& name, double value) {
  constexpr double kMaxExact = 9007199254740992;  // 2⁵³
  if (!(value >= 0 && value <= kMaxExact) ||
      (std::is_integral_v<Figure> && value != std::floor(value)))
    throw std::runtime_error("serialised map: figure '" + name + "' = " + std::to_string(value));
  return static_cast<Figure>(value);
}

/// Takes those that `statistics` has out of `figures`.
template <class Statistics>
void assignFigures(Statistics& statistics, const std::string& prefix,
                   std::map<std::string, double>& figures) {
  Statistics::visit(
      [&](const StatisticInfo& info, auto& field) {
        using Field = std::decay_t<decltype(field)>;
        if constexpr (IsStatistics<Field>::value)
          assignFigures(field, prefix + info.key + ".", figures);
        else if (const auto figure = figures.extract(prefix + info.key))
          field = toFigure<Field>(figure.key(), figure.mapped());
      },
      statistics);
}

/// Counts up to 2⁵³ are exact.
template <class Statistics>
void writeStatistics(ByteWriter& out, const Statistics& statistics) {
  std::map<std::string, double> figures;
  collectFigures(statistics, "", figures);
  out.named(figures);
}

/// A figure that is not there is one that an earlier version did not count: it stays 0. Throws
/// std::runtime_error for one that is not known, which a later version wrote, and for what is no
/// count.
template <class Statistics>
void readStatistics(ByteReader& in, Statistics& statistics) {
  auto figures = in.named<double>();
  assignFigures(statistics, "", figures);
  if (!figures.empty())
    throw std::runtime_error("serialised map: unknown figure '" + figures.begin()->first + "'");
}

}  // namespace csom
