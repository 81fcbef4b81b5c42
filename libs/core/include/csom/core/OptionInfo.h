// SPDX-License-Identifier: BSD-3-Clause
// What is known about an option beside its value, and options as text.
#pragma once

#include <csom/core/Error.h>

#include <limits>
#include <string>
#include <type_traits>

namespace csom {

/// Thrown for an option that cannot be; the message names the key, the value and what is accepted.
class OptionError : public ConfigError {
 public:
  using ConfigError::ConfigError;
};

/// What a number may be, both ends included.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

/// Structs of options list their fields once, beside them, by calling visitor(OptionInfo, field)
/// for each. Ini files, reports, map files, streams and documentation are written and read by that
/// list.
struct OptionInfo {
  const char* key;   ///< in ini files
  const char* unit;  ///< "" if it has none
  const char* help;
  Range range{};
};

/// Texts as in ini files. Parsing throws OptionError with what is accepted.
std::string toString(bool value);
std::string toString(int value);
std::string toString(double value);
void parse(const std::string& key, const std::string& text, bool& value);
void parse(const std::string& key, const std::string& text, int& value);
void parse(const std::string& key, const std::string& text, double& value);

namespace detail {

[[noreturn]] void rejectOption(const std::string& key, const std::string& value,
                               const std::string& accepted);
/// " (1 to 4)", or nothing for numbers of any size.
std::string rangeText(const Range& range);
/// Both throw OptionError.
void requireInRange(const OptionInfo& option, int value);
void requireInRange(const OptionInfo& option, double value);

}  // namespace detail

/// Throws OptionError if a number is outside of its range. `visit(visitor)` visits a struct.
template <class Visit>
void requireInRanges(Visit&& visit) {
  visit([](const OptionInfo& option, const auto& field) {
    if constexpr (std::is_same_v<std::decay_t<decltype(field)>, int> ||
                  std::is_same_v<std::decay_t<decltype(field)>, double>)
      detail::requireInRange(option, field);
  });
}

}  // namespace csom
