// SPDX-License-Identifier: BSD-3-Clause
// The label set of a map and of all its copies.
#include <csom/maps/SharedLabels.h>

namespace csom {

std::shared_ptr<const SharedLabels> SharedLabels::fromYaml(const std::string& text) {
  // All copies that one filter makes have one label set: the last one is enough.
  thread_local std::shared_ptr<const SharedLabels> last;
  if (!last || last->yaml() != text)
    last = std::make_shared<const SharedLabels>(LabelSet::fromYaml(text, "serialised map"));
  return last;
}

const std::string& SharedLabels::yaml() const {
  std::call_once(made_, [this] { yaml_ = set_.toYaml(); });
  return yaml_;
}

}  // namespace csom
