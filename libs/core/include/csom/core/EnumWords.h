// SPDX-License-Identifier: BSD-3-Clause
// Enumerations as words of ini files.
#pragma once

#include <csom/core/OptionInfo.h>

#include <array>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>

namespace csom {

/// Every value of an enumeration with the word that stands for it.
template <class Enum, std::size_t N>
using EnumWords = std::array<std::pair<Enum, const char*>, N>;

/// To be specialised as EnumWords beside an enumeration, which then has all functions below.
template <class Enum>
constexpr std::array<std::pair<Enum, const char*>, 0> kWords{};

template <class Enum, std::enable_if_t<(kWords<Enum>.size() > 0), int> = 0>
std::string toString(Enum value) {
  for (const auto& [candidate, word] : kWords<Enum>) {
    if (candidate == value) return word;
  }
  return "invalid";
}

/// "sparse | linear"
template <class Enum, std::enable_if_t<(kWords<Enum>.size() > 0), int> = 0>
std::string acceptedWords(Enum /*any value*/) {
  std::string accepted;
  for (const auto& [value, word] : kWords<Enum>)
    accepted += (accepted.empty() ? "" : " | ") + std::string(word);
  return accepted;
}

/// Throws OptionError with the accepted words.
template <class Enum, std::enable_if_t<(kWords<Enum>.size() > 0), int> = 0>
void parse(const std::string& key, const std::string& text, Enum& value) {
  for (const auto& [candidate, word] : kWords<Enum>) {
    if (text == word) {
      value = candidate;
      return;
    }
  }
  detail::rejectOption(key, text, acceptedWords(value));
}

/// The help of an option, and what it accepts.
template <class Field>
std::string fullHelp(const OptionInfo& option, const Field& field) {
  std::string text = option.help;
  if constexpr (std::is_enum_v<Field>) text += ": " + acceptedWords(field);
  return text + detail::rangeText(option.range);
}

}  // namespace csom
