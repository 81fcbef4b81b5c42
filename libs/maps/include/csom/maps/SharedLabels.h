// SPDX-License-Identifier: BSD-3-Clause
// The label set of a map and of all its copies.
#pragma once

#include <csom/io/LabelSet.h>

#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace csom {

/// A label set with its canonical text. To write that text and to parse it takes longer than to
/// copy a small map, and a particle filter copies maps by streams: both are done once.
/// Thread-safe.
class SharedLabels {
 public:
  explicit SharedLabels(LabelSet set) : set_(std::move(set)) {}

  /// The labels of a text that yaml() has returned. Hands out the last ones of this thread again if
  /// the text is the same. Throws FileError.
  static std::shared_ptr<const SharedLabels> fromYaml(const std::string& text);

  const LabelSet& set() const { return set_; }
  /// LabelSet::toYaml(), made when first asked for.
  const std::string& yaml() const;

 private:
  LabelSet set_;
  mutable std::once_flag made_;
  mutable std::string yaml_;
};

}  // namespace csom
