// SPDX-License-Identifier: BSD-3-Clause
// Arguments that are lists of numbers or one of several words.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <map>
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

/// Transforms one of the words, in upper or lower case, into its value; the error lists the words.
template <class Enum>
CLI::Validator oneOf(const std::map<std::string, Enum>& words) {
  const auto transform = [words](std::string& text) {
    const auto found = words.find(CLI::detail::to_lower(text));
    if (found != words.end()) {
      text = std::to_string(static_cast<int>(found->second));
      return std::string();
    }
    std::string accepted;
    for (const auto& [word, value] : words) accepted += (accepted.empty() ? "" : ", ") + word;
    return "'" + text + "': expected one of " + accepted;
  };
  return CLI::Validator(transform, "");
}

}  // namespace csom
