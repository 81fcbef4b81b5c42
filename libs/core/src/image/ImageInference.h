// SPDX-License-Identifier: BSD-3-Clause
// Surfaces and free space of a scan with an image (surface-csom).
#pragma once

#include <csom/core/CountIncrements.h>
#include <csom/core/Options.h>
#include <csom/core/ScanPreparation.h>
#include <csom/core/ScanReport.h>

namespace csom::detail {

/// What a scan with an image adds to a map, free space included: no kernel, no search for
/// neighbours, the image knows them.
ScanIncrements inferFromImage(const PreparedScan& scan, const Options& options, ScanReport& report);

}  // namespace csom::detail
