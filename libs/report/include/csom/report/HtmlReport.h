// SPDX-License-Identifier: BSD-3-Clause
// One self-contained page about one run.
#pragma once

#include <csom/report/MapFigures.h>
#include <csom/report/RunRecord.h>

#include <cstdint>
#include <string>
#include <vector>

namespace csom {

/// HTML 5 text that needs nothing else: no script, no network, pictures inside. `top_view` is a PNG
/// file; if empty, the page has no picture. Every text of the record is escaped.
std::string htmlReport(const RunRecord& record, const MapFigures& figures,
                       const std::vector<std::uint8_t>& top_view);

}  // namespace csom
