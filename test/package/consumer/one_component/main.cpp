// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/SemanticMap.h>

int main() {
  const csom::SemanticMap map;
  return map.empty() ? 0 : 1;
}
