// SPDX-License-Identifier: BSD-3-Clause
// Scans to measure with: of a street made up here, or SemanticKITTI's.
#pragma once

#include <csom/core/types.h>

#include <string>
#include <vector>

namespace csom::bench {

/// What a spinning laser of 64 beams sees between two rows of houses: ground up to 60 m away,
/// walls, and a car every 10 m. `columns` directions a turn; points = 64 · columns at most. Five
/// classes.
Scan streetScan(int columns);

/// The first `count` scans of a SemanticKITTI folder with predicted labels, each moved to its pose.
/// Classes: those of config/labels/semantickitti.yaml. Throws FileError.
std::vector<Scan> semanticKittiScans(const std::string& folder, int count);

}  // namespace csom::bench
