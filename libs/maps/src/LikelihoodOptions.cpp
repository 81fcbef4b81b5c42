// SPDX-License-Identifier: BSD-3-Clause
#include <csom/maps/LikelihoodOptions.h>

namespace csom {

void LikelihoodOptions::validate() const {
  requireInRanges([&](auto&& visitor) { visit(*this, visitor); });
}

}  // namespace csom
