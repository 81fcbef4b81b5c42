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

/// Names of figures inside each other are joined by dots. Texts are not written.
template <class Statistics>
void collectFigures(const Statistics& statistics, const std::string& prefix,
                    std::map<std::string, double>& figures) {
  Statistics::visit(
      [&](const StatisticInfo& info, const auto& field) {
        using Field = std::decay_t<decltype(field)>;
        if constexpr (IsStatistics<Field>::value)
          collectFigures(field, prefix + info.key + ".", figures);
        else if constexpr (std::is_arithmetic_v<Field>)
          figures[prefix + info.key] = static_cast<double>(field);
      },
      statistics);
}

template <class Statistics>
void assignFigures(Statistics& statistics, const std::string& prefix,
                   std::map<std::string, double>& figures) {
  Statistics::visit(
      [&](const StatisticInfo& info, auto& field) {
        using Field = std::decay_t<decltype(field)>;
        if constexpr (IsStatistics<Field>::value) {
          assignFigures(field, prefix + info.key + ".", figures);
        } else if constexpr (std::is_arithmetic_v<Field>) {
          const auto figure = figures.find(prefix + info.key);
          if (figure == figures.end()) return;
          constexpr double kMaxExact = 9007199254740992;  // 2⁵³
          const double value = figure->second;
          if (!(value >= 0 && value <= kMaxExact) ||
              (std::is_integral_v<Field> && value != std::floor(value)))
            throw std::runtime_error("serialised map: a count that cannot be");
          field = static_cast<Field>(value);
          figures.erase(figure);
        }
      },
      statistics);
}

/// Counts up to 2⁵³ are exact.
template <class Statistics>
void writeStatistics(ByteWriter& out, const Statistics& statistics) {
  std::map<std::string, double> figures;
  collectFigures(statistics, "", figures);
  out.number(static_cast<std::uint64_t>(figures.size()));
  for (const auto& [name, figure] : figures) {
    out.text(name);
    out.number(figure);
  }
}

/// Throws std::runtime_error for a figure that is not known: a later version wrote it.
template <class Statistics>
void readStatistics(ByteReader& in, Statistics& statistics) {
  constexpr std::size_t kSmallest = sizeof(std::uint32_t) + sizeof(double);
  std::map<std::string, double> figures;
  for (std::size_t left = in.count(kSmallest); left > 0; --left) {
    const std::string name = in.text();
    figures[name] = in.number<double>();
  }
  assignFigures(statistics, "", figures);
  if (!figures.empty())
    throw std::runtime_error("serialised map: unknown figure '" + figures.begin()->first + "'");
}

}  // namespace csom
