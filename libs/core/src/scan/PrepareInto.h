// SPDX-License-Identifier: BSD-3-Clause
// prepareScan() with memory that is kept from scan to scan.
#pragma once

#include <csom/core/ScanPreparation.h>

namespace csom::detail {

/// As csom::prepareScan(). What is in `out` before does not matter.
void prepareScan(const Scan& scan, const Options& options, ScanReport& report, PreparedScan& out);

}  // namespace csom::detail
