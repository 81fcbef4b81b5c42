// SPDX-License-Identifier: BSD-3-Clause
// The colours of pictures: classes as the label set has them, and the rest.
#pragma once

#include <csom/io/LabelSet.h>

#include <string>

namespace csom {

constexpr Color kInk{40, 40, 40};
constexpr Color kFrame{190, 190, 190};
constexpr Color kFreeSpace{236, 236, 236};
constexpr Color kUnknown{255, 255, 255};

/// Name and colour of a class, even of one that the label set does not have.
inline LabelClass classOf(const LabelSet& labels, ClassId k) {
  if (k < labels.numberOfClasses()) return labels.at(k);
  LabelClass unnamed;
  unnamed.id = k;
  unnamed.name = "class " + std::to_string(k);
  return unnamed;
}

}  // namespace csom
