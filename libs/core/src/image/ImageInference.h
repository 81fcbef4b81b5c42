// SPDX-License-Identifier: BSD-3-Clause
// Surfaces and free space of a scan with an image (surface-csom).
#pragma once

#include <csom/core/CountIncrements.h>
#include <csom/core/Options.h>
#include <csom/core/ScanPreparation.h>
#include <csom/core/ScanReport.h>

#include <vector>

#include "image/DepthCube.h"
#include "image/Facets.h"
#include "image/ImageBeams.h"
#include "image/VoxelWords.h"

namespace csom::detail {

/// Kept from scan to scan for its memory alone: what is in it does not matter.
struct CSOM_OF_ONE_BINARY ImageMemory {
  ImageBeams beams;
  Facets facets;
  std::vector<VoxelWords> parts;
  DepthCube cube;
};

/// What a scan with an image adds to a map, free space included: no kernel, no search for
/// neighbours, the image knows them.
ScanIncrements inferFromImage(const PreparedScan& scan, const Options& options, ScanReport& report,
                              ImageMemory& memory);

}  // namespace csom::detail
