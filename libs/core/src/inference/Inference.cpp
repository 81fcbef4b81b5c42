// SPDX-License-Identifier: BSD-3-Clause
#include "inference/Inference.h"

#include <csom/core/Method.h>

#include <algorithm>

namespace csom {

namespace detail {

const MethodEntry& entryOf(Method method) {
  const auto entry = std::find_if(kMethods.begin(), kMethods.end(),
                                  [&](const MethodEntry& e) { return e.method == method; });
  if (entry == kMethods.end()) rejectOption("method", "invalid", acceptedWords(method));
  return *entry;
}

ScanIncrements inferIncrements(const PreparedScan& scan, const Options& options,
                               ScanReport& report) {
  if (scan.blocks.empty()) return {};
  ScanIncrements increments = entryOf(options.method).infer(scan, options, report);
  increments.erase(
      std::remove_if(increments.begin(), increments.end(),
                     [](const ChunkIncrements& chunk) { return chunk.increments.empty(); }),
      increments.end());
  return increments;
}

}  // namespace detail

std::string toString(Method value) {
  return detail::entryOf(value).word;
}

std::string acceptedWords(Method /*any*/) {
  std::string accepted;
  for (const detail::MethodEntry& entry : detail::kMethods)
    accepted += (accepted.empty() ? "" : " | ") + std::string(entry.word);
  return accepted;
}

void parse(const std::string& key, const std::string& text, Method& value) {
  const auto entry = std::find_if(detail::kMethods.begin(), detail::kMethods.end(),
                                  [&](const detail::MethodEntry& e) { return text == e.word; });
  if (entry == detail::kMethods.end()) detail::rejectOption(key, text, acceptedWords(value));
  value = entry->method;
}

}  // namespace csom
