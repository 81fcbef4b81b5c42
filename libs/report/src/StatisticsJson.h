// SPDX-License-Identifier: BSD-3-Clause
// Statistics as JSON objects, and back.
#pragma once

#include <csom/core/Statistic.h>

#include <nlohmann/json.hpp>

#include "JsonFields.h"

namespace csom {

template <class Statistics>
nlohmann::ordered_json statisticsToJson(const Statistics& statistics) {
  auto json = nlohmann::ordered_json::object();
  Statistics::visit(
      [&](const StatisticInfo& info, const auto& field) {
        if constexpr (IsStatistics<std::decay_t<decltype(field)>>::value)
          json[info.key] = statisticsToJson(field);
        else
          json[info.key] = field;
      },
      statistics);
  return json;
}

/// Throws FileError for a figure that is missing or none.
template <class Statistics>
Statistics statisticsFromJson(const JsonFields& json) {
  Statistics statistics;
  Statistics::visit(
      [&](const StatisticInfo& info, auto& field) {
        using Field = std::decay_t<decltype(field)>;
        if constexpr (IsStatistics<Field>::value)
          field = statisticsFromJson<Field>(json.object(info.key));
        else if constexpr (std::is_integral_v<Field>)
          field = json.count(info.key);
        else
          field = json.number(info.key);
      },
      statistics);
  return statistics;
}

}  // namespace csom
