// SPDX-License-Identifier: BSD-3-Clause
// Scores as Markdown tables, beside what the paper and its code reach.
#pragma once

#include <csom/protocols/Evaluation.h>

#include <string>

namespace csom {

/// A section a protocol: `## P1: …`, what went in, tables; then the runtime table, if at least one
/// of its columns is there. Percentages but for AUC and calibration.
std::string toMarkdown(const Evaluation& evaluation);

}  // namespace csom
