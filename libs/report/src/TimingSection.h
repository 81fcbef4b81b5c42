// SPDX-License-Identifier: BSD-3-Clause
// What the report page says about time.
#pragma once

#include <csom/report/RunRecord.h>

#include <ostream>

namespace csom {

/// "Time per observation": charts and a table of the stages, for an HtmlPage with `charts`; nothing
/// if no observation was inserted.
void writeTiming(std::ostream& page, const RunRecord& record);

}  // namespace csom
