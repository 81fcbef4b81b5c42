// SPDX-License-Identifier: BSD-3-Clause
// Arguments that are lists of numbers.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>

namespace csom {

/// N finite numbers separated by commas. Throws CLI::ValidationError naming `option`.
template <std::size_t N>
std::array<double, N> parseNumbers(const std::string& option, const std::string& text) {
  std::array<double, N> numbers{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < N; ++i) {
    const auto result = std::from_chars(at, end, numbers[i]);
    const bool last = i + 1 == N;
    const bool separated = last ? result.ptr == end : result.ptr != end && *result.ptr == ',';
    if (result.ec != std::errc() || !separated || !std::isfinite(numbers[i]))
      throw CLI::ValidationError(option, "'" + text + "' must be " + std::to_string(N) +
                                             " finite numbers separated by commas");
    at = result.ptr + (last ? 0 : 1);
  }
  return numbers;
}

}  // namespace csom
