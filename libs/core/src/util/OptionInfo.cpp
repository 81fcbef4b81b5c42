// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/OptionInfo.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

namespace csom {

namespace {

/// Nothing if the text is no number, or an infinite one.
std::optional<double> finiteNumber(const std::string& text) {
  const char* const end = text.data() + text.size();
  double number = 0;
  const auto result = std::from_chars(text.data(), end, number);
  if (result.ec != std::errc() || result.ptr != end || !std::isfinite(number)) return std::nullopt;
  return number;
}

}  // namespace

namespace detail {

void rejectOption(const std::string& key, const std::string& value, const std::string& accepted) {
  throw OptionError(key + " = " + value + ": expected " + accepted);
}

std::string rangeText(const Range& range) {
  constexpr double kAsGoodAsNone = 1e5;
  std::array<char, 64> text{};
  if (range.max < kAsGoodAsNone)
    std::snprintf(text.data(), text.size(), " (%g to %g)", range.min, range.max);
  else if (range.min > 0)
    std::snprintf(text.data(), text.size(), " (at least %g)", range.min);
  return text.data();
}

void requireInRange(const OptionInfo& option, int value) {
  if (value < option.range.min || value > option.range.max)
    rejectOption(option.key, toString(value),
                 toString(option.range.min) + " to " + toString(option.range.max));
}

void requireInRange(const OptionInfo& option, double value) {
  if (!std::isfinite(value)) rejectOption(option.key, toString(value), "a finite number");
  if (value < option.range.min || value > option.range.max)
    rejectOption(
        option.key, toString(value),
        "a number from " + toString(option.range.min) + " to " + toString(option.range.max));
}

}  // namespace detail

std::string toString(bool value) {
  return value ? "on" : "off";
}
std::string toString(int value) {
  return std::to_string(value);
}
std::string toString(double value) {
  std::array<char, 32> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

void parse(const std::string& key, const std::string& text, bool& value) {
  // The words of MRPT's ini files in any case, and ours; formulas give 1.000000e+00.
  std::string word = text;
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const std::optional<double> number = finiteNumber(word);
  if (word == "on" || word == "true" || word == "yes" || number == 1.0) {
    value = true;
  } else if (word == "off" || word == "false" || word == "no" || number == 0.0) {
    value = false;
  } else {
    detail::rejectOption(key, text, "on | off");
  }
}

void parse(const std::string& key, const std::string& text, int& value) {
  const std::optional<double> number = finiteNumber(text);
  constexpr double kLargest = std::numeric_limits<int>::max();
  if (!number || *number != std::floor(*number) || std::abs(*number) > kLargest)
    detail::rejectOption(key, text, "a whole number");
  value = static_cast<int>(*number);
}

void parse(const std::string& key, const std::string& text, double& value) {
  const std::optional<double> number = finiteNumber(text);
  if (!number) detail::rejectOption(key, text, "a finite number");
  value = *number;
}

}  // namespace csom
