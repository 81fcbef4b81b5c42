// SPDX-License-Identifier: BSD-3-Clause
// A confusion matrix as a table whose cells are darker the more voxels they hold.
#pragma once

#include <csom/eval/ConfusionMatrix.h>
#include <csom/io/LabelSet.h>

#include <string>

namespace csom {

/// A row a true class, with the share of its voxels that the map gives each class, then precision,
/// recall and F1. Classes that neither side has are left out. HTML.
std::string confusionTable(const ConfusionMatrix& matrix, const LabelSet& labels);

}  // namespace csom
