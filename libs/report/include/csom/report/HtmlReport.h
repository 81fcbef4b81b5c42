// SPDX-License-Identifier: BSD-3-Clause
// One self-contained page about one run.
#pragma once

#include <csom/io/MapFile.h>
#include <csom/report/MapFigures.h>
#include <csom/report/RunRecord.h>

#include <cstdint>
#include <string>
#include <vector>

namespace csom {

/// HTML 5 text that needs nothing else: no network, and the pictures, the voxels and the scripts that
/// show them inside. `figures` are those of the document. `top_view` is a PNG file; if empty, the
/// page has no such picture. Every text of the record is escaped.
std::string htmlReport(const RunRecord& record, const MapDocument& document,
                       const MapFigures& figures, const std::vector<std::uint8_t>& top_view);

}  // namespace csom
