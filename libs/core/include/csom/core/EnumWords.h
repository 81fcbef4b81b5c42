// SPDX-License-Identifier: BSD-3-Clause
// Enumerations as words of ini files.
#pragma once

#include <csom/core/Options.h>

#include <array>
#include <cstddef>
#include <string>
#include <utility>

namespace csom::detail {

/// Every value of an enumeration with the word that stands for it.
template <class Enum, std::size_t N>
using EnumWords = std::array<std::pair<Enum, const char*>, N>;

template <class Enum, std::size_t N>
std::string wordOf(const EnumWords<Enum, N>& words, Enum value) {
  for (const auto& [candidate, word] : words) {
    if (candidate == value) return word;
  }
  return "invalid";
}

/// Throws OptionError with the accepted words.
template <class Enum, std::size_t N>
void parseWord(const EnumWords<Enum, N>& words, const std::string& key, const std::string& text,
               Enum& value) {
  std::string accepted;
  for (const auto& [candidate, word] : words) {
    if (text == word) {
      value = candidate;
      return;
    }
    accepted += (accepted.empty() ? "" : " | ") + std::string(word);
  }
  throw OptionError(key + " = " + text + ": expected " + accepted);
}

}  // namespace csom::detail
