// SPDX-License-Identifier: BSD-3-Clause
// Figures of a run by their names.
#pragma once

#include <type_traits>
#include <utility>

namespace csom {

/// A figure of a struct of statistics. Such a struct lists its figures once, beside them:
///
///     template <class Visitor, class... Selves>
///     static void visit(Visitor&& visitor, Selves&... s) {
///       visitor(StatisticInfo{"read", "images"}, s.images_read...);
///     }
///
/// Whatever writes, reads, adds or shows statistics goes through that list (several at once, where
/// they are added), so a new figure is a field and a line. Fields are counts, numbers, or structs
/// of statistics themselves.
struct StatisticInfo {
  const char* key;         ///< in files
  const char* words = "";  ///< in tables of reports; empty: no table has it
};

namespace detail {
struct VisitorOfAnything {
  template <class... Fields>
  void operator()(const StatisticInfo&, Fields&...) const {}
};
}  // namespace detail

/// Whether a type is a struct of statistics.
template <class T, class = void>
struct IsStatistics : std::false_type {};
template <class T>
struct IsStatistics<
    T, std::void_t<decltype(T::visit(detail::VisitorOfAnything{}, std::declval<T&>()))>>
    : std::true_type {};

/// Adds all figures of `more` to those of `sum`.
template <class Statistics>
void addStatistics(Statistics& sum, const Statistics& more) {
  Statistics::visit(
      [](const StatisticInfo&, auto& to, const auto& from) {
        if constexpr (IsStatistics<std::decay_t<decltype(to)>>::value)
          addStatistics(to, from);
        else if constexpr (std::is_arithmetic_v<std::decay_t<decltype(to)>>)
          to += from;
      },
      sum, more);
}

}  // namespace csom
